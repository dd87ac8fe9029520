# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A marker for tests of what is not installed everywhere, which imports nothing for it."""

from importlib.util import find_spec

import pytest


def needs(module: str) -> pytest.MarkDecorator:
    """Return a marker that skips a test where a module is not installed."""
    return pytest.mark.skipif(find_spec(module) is None, reason=f'{module} is not installed')
