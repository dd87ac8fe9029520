# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A cache without a floor, for tests that change how floors are computed."""

import pytest


@pytest.fixture
def own_cache(tmp_path, monkeypatch):
    """Keep the floors of a test in a folder of its own; other tests share one."""
    monkeypatch.setenv('DDCT_CACHE', str(tmp_path / 'cache'))
