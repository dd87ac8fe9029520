# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Columns that studies share."""

from types import SimpleNamespace
from typing import Any

import pytest

from ddct_bringup.reproduction.studies.study import friction_kj


@pytest.mark.parametrize(('energy_j', 'energy_kj'), [(12300.0, 12.3), (0.0, 0.0), (None, None)])
def test_the_friction_work_is_the_metric_in_kj_and_none_without_it(energy_j, energy_kj):
    run: Any = SimpleNamespace(metrics={'friction_work_j': energy_j})
    assert friction_kj(run) == energy_kj
