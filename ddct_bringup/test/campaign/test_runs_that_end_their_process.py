# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A run that ends its process is a row with the reason, the same with any workers."""

from pathlib import Path
from typing import Any

import pytest
from pyarrow import parquet
from small_tuning import leave_out_pictures, tuning

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.conduct import carry_out
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.tuning.conduct import carry_out_tuning
from ddct_bringup.tuning.trial import FEASIBLE, INFEASIBLE
from ddct_bringup.verdict.limits import packaged_limits

pytestmark = [pytest.mark.slow, pytest.mark.process]
CRASHES = """
import ctypes
import os

from ddct_controllers.interface import Command, Controller
from ddct_plant.base.options import Option


class Crashes(Controller):
    options = {'gain': Option(0.1, 'gain')}

    def __init__(self, context):
        self.gain = context.gains['gain']

    def reset(self):
        pass

    def update(self, measurement):
        if self.gain == 0.2:
            ctypes.string_at(0)
        if self.gain == 0.3:
            os._exit(3)
        return Command(-self.gain * measurement.slip_error_rpm)
"""
REASONS = {0.2: 'its process crashed (SIGSEGV)', 0.3: 'its process ended with exit code 3'}
"""Reasons by the gain of the run; runs with other gains have none."""


@pytest.fixture
def crashes(tmp_path: Path) -> Path:
    """Return the file of a controller with gains that end its process."""
    file = tmp_path / 'crashes.py'
    file.write_text(CRASHES, encoding='utf-8')
    return file


def test_rows_of_a_campaign_have_the_reason(crashes: Path, tmp_path: Path) -> None:
    grid = {'controllers.Crashes.gain': [0.1, 0.2, 0.3, 0.4], 'duration_s': [0.7]}
    content: dict[str, Any] = {'controllers': ['pi', 'crashes.py'], 'grid': grid}
    files = [
        carry_out(
            Campaign(spec_of(content, tmp_path)),
            packaged_limits(),
            tmp_path / str(count),
            workers=count,
        )
        for count in (1, 2)
    ]
    assert files[0].read_bytes() == files[1].read_bytes()
    rows = parquet.read_table(files[0]).to_pylist()
    assert [row['index'] for row in rows] == list(range(8))
    for row in rows:
        of_pi = row['controller'] == 'pi'
        reason = '' if of_pi else REASONS.get(row['controllers.Crashes.gain'], '')
        assert (row['reason'], row['valid']) == (reason, not reason)


@pytest.mark.nightly
def test_a_trial_of_a_tuning_is_infeasible(
    crashes: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    leave_out_pictures(monkeypatch)
    crashes.write_text(CRASHES.replace('== 0.2', '> 0.15'), encoding='utf-8')
    made = [
        carry_out_tuning(
            tuning(
                str(crashes),
                parameters={'gain': {'low': 0.05, 'high': 0.25}},
                constraints={'engaged': {'at_least': 0.0}},
                objectives={'torsion_speed_std_rpm': {}},
                trials=3,
            ),
            tmp_path / str(count),
            workers=count,
        )
        for count in (1, 2)
    ]
    assert [each.values for each in made[0]] == [each.values for each in made[1]]
    for trials in made:
        states = {each.values['gain'] > 0.15: each.state for each in trials}
        assert states == {False: FEASIBLE, True: INFEASIBLE}
