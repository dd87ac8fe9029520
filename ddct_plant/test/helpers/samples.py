# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Cases of which `make test` has a sample, and `make test-nightly` the others."""

from collections.abc import Iterable
from typing import Any

import pytest

NIGHTLY = 'nightly'
"""Marker of a test that only `make test-nightly` runs."""


def sampled(cases: Iterable[Any], every: int) -> list[Any]:
    """Return cases for `parametrize`; all but the first of each `every` ones are nightly."""
    return [
        pytest.param(
            *(case if isinstance(case, tuple) else (case,)),
            marks=[getattr(pytest.mark, NIGHTLY)] if number % every else [],
        )
        for number, case in enumerate(cases)
    ]
