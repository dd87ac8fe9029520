# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The engine keeps a target speed until the shaft has caught up, and then slip is zero."""

import numpy as np
import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.choices.settings import ARCHITECTURES
from ddct_plant.scenario.control import EngineSpeedReference
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from ddct_reference.engine_speed_target import EngineSpeedTarget
from ddct_reference.factory import make_reference

HOLD_150 = EngineSpeedReference(time_s=(0.0,), speed_rad_s=(150.0,))
SLOPE = 100.0
RATE = 50.0
"""Acceleration of the shaft in a launch from rest, in rad/s^2."""
TARGET = [
    'reference.shape=engine_speed_target',
    'engine_speed_reference.time_s=[0.0]',
    'engine_speed_reference.speed_rad_s=[210.0]',
]


def launch(steps: int, start_step: int = 0, preview_steps: int = 0) -> list[list[float]]:
    """Return the reference of a launch at each step; the real slip stays at 120 rad/s."""
    reference = EngineSpeedTarget(HOLD_150, SLOPE, start_step, preview_steps)
    return [reference.update(k, 120.0, 0.01 * RATE * k)[0] for k in range(steps)]


def test_it_starts_at_the_measured_slip_and_leads_the_engine_at_the_slope():
    found = [speeds[0] for speeds in launch(31)]
    assert found[0] == 120.0
    assert np.diff(found) == pytest.approx(np.full(30, 0.01 * (SLOPE - RATE)))


def test_it_then_keeps_the_engine_speed_until_the_shaft_has_caught_up_and_stays_zero():
    found = np.array([speeds[0] for speeds in launch(400)])
    shaft = 0.01 * RATE * np.arange(400)
    assert (found + shaft)[40:299] == pytest.approx(150.0)
    assert not np.any(found[301:])
    assert np.all(found[:299] > 0.0)


def test_it_stays_zero_when_the_shaft_falls_back():
    reference = EngineSpeedTarget(HOLD_150, 1e4, 0)
    found = [reference.update(k, 50.0, w)[0][0] for k, w in enumerate([100.0, 151.0, 140.0])]
    assert found == [50.0, 0.0, 0.0]


def test_it_comes_to_zero_from_below_too():
    reference = EngineSpeedTarget(HOLD_150, 1e4, 0)
    found = [reference.update(k, -20.0, w)[0][0] for k, w in enumerate([180.0, 170.0, 149.0])]
    assert found == pytest.approx([-20.0, -20.0, 0.0])


def test_it_equals_the_slip_until_control_starts_and_without_slip_is_zero():
    reference = EngineSpeedTarget(HOLD_150, SLOPE, 3)
    assert [reference.update(k, w, 60.0)[0][0] for k, w in enumerate([5.0, 7.0, -2.0])] == [
        *(5.0, 7.0, -2.0)
    ]
    locked = EngineSpeedTarget(HOLD_150, SLOPE, 0)
    assert [locked.update(k, 0.0, 60.0)[0][0] for k in range(3)] == [0.0] * 3


def test_the_preview_is_the_later_reference_while_the_shaft_accelerates_steadily():
    ahead = launch(320, preview_steps=22)
    coming = [speeds[0] for speeds in launch(350)]
    for step in range(1, 320):
        assert ahead[step] == pytest.approx(coming[step : step + 23], abs=1e-9)


def test_before_control_the_preview_starts_from_the_present_slip():
    reference = EngineSpeedTarget(HOLD_150, SLOPE, 2, preview_steps=4)
    speeds, rates = reference.update(0, 40.0, 60.0)
    assert speeds == pytest.approx([40.0, 40.0, 40.0, 41.0, 42.0])
    assert rates == pytest.approx([0.0, 0.0, SLOPE, SLOPE, SLOPE])


def test_a_missing_tick_changes_nothing_of_the_later_ones():
    whole, gap = (EngineSpeedTarget(HOLD_150, SLOPE, 0) for _ in range(2))
    for step in range(40):
        expected = whole.update(step, 120.0, 0.01 * RATE * step)
        if step not in (11, 12, 13):
            assert gap.update(step, 120.0, 0.01 * RATE * step)[0] == pytest.approx(expected[0])


@pytest.mark.parametrize('architecture', ARCHITECTURES)
def test_only_the_detailed_architecture_may_use_it(architecture):
    scenario = load_scenario('thesis', TARGET)
    if architecture == 'detailed':
        assert make_reference(KnownSettings(scenario)).follows_shaft
        return
    with refused(ParameterError, key='reference.shape'):
        RunSettings(KnownSettings(scenario, architecture))


def test_it_needs_a_target_engine_speed():
    with refused(ParameterError, key='reference.shape'):
        RunSettings(KnownSettings(load_scenario('thesis', TARGET[:1])))
