# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Small results without charts; one campaign has its figure, one documented comparison all."""

from collections.abc import Iterator

import pytest
from verified import leave_out_charts


@pytest.fixture(scope='module', autouse=True)
def no_charts() -> Iterator[None]:
    """Leave out the charts when a result is made, and when it is made again."""
    with pytest.MonkeyPatch.context() as patch:
        leave_out_charts(patch)
        yield
