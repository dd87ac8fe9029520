# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Floors of these tests are computed, not taken from the user's cache."""

import pytest


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    """Keep the floors of each test in a folder of its own."""
    monkeypatch.setenv('DDCT_CACHE', str(tmp_path / 'cache'))
