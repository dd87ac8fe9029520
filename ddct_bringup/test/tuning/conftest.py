# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A tuning that is carried out once."""

from pathlib import Path

import pytest
from small_tuning import made_tuning

from ddct_bringup.tuning import evaluation


@pytest.fixture(scope='session')
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a finished tuning, which no test changes."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(evaluation, 'LEAST_TOGETHER', 1)  # so that trials end early
        return made_tuning(tmp_path_factory.mktemp('tuning') / 'out')
