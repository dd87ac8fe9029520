# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The gear shifts of 2.5 s are those of 2 s to the last bit, as long as these last."""

import hashlib

import numpy as np
import pytest
from samples import sampled

from ddct_bringup.run.headless import run_headless
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SHORT_S, ROWS = 2.0, 201
SHIFTS = {
    'upshift': 'mpc3',
    'upshift_2_3': 'pi',
    'upshift_full': 'ls8',
    'upshift_hot': 'hinf1',
    'upshift_light': 'torque_estimator',
}
"""Every packaged gear shift, each with another controller with feedback."""


def hashes(scenario: str, **changes: float) -> tuple[int, dict[str, str]]:
    """Return the steps of a run, and by signal the hash of its rows of the first 2 s."""
    settings = RunSettings(KnownSettings(load_scenario(scenario, changes)))
    run = run_headless(settings, SHIFTS[scenario])
    digests = {}
    for name, values in run.signals.items():
        rows = values[:ROWS]
        content = rows.tobytes() if isinstance(rows, np.ndarray) else repr(rows).encode()
        digests[name] = hashlib.sha256(content).hexdigest()
    return run.steps, digests


@pytest.mark.slow
@pytest.mark.parametrize('scenario', sampled(SHIFTS, every=2))
def test_a_shift_of_2_5_s_begins_as_one_of_2_s_in_every_signal_and_status_text(scenario):
    steps, whole = hashes(scenario)
    short_steps, short = hashes(scenario, duration_s=SHORT_S)
    assert (steps, short_steps) == (250, ROWS - 1)
    assert {'status', 'off_going_phase_events', 'slip_speed', 'torque_cut'} <= whole.keys()
    assert whole == short
