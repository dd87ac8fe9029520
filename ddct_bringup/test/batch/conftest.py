# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The runs of a file, which its fixture `runs` gives, together and step by step, each once."""

import pytest
from step_by_step import batch_of, step_by_step


@pytest.fixture(scope='module')
def batch(runs):
    """Return results and signals of the runs in one batch, as `batch_of` has them."""
    return batch_of(runs)


@pytest.fixture(scope='module')
def serial(runs):
    """Return results and signals of the runs step by step."""
    return [step_by_step(*run) for run in runs]
