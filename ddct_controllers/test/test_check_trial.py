# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Trials of `ddct check`: their measurements, times and scaled torques."""

from contextlib import nullcontext
from typing import Any

import numpy as np
import pytest
from refusals import refused

from ddct_controllers.check.checks import check_controller
from ddct_controllers.check.loops import rate, update_time
from ddct_controllers.check.subject import CheckFailedError, Subject
from ddct_controllers.check.trial import ClosedLoopLog, closed_trial
from ddct_controllers.check.watch import OutputMonitor
from ddct_controllers.interface import Command, Controller
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings


def slip(*changes: str) -> list[float]:
    settings = RunSettings(KnownSettings(load_scenario('thesis', changes)))
    return closed_trial(settings.known, make_controller('pi', settings.known)).slip


def test_trials_leave_the_sensors_of_a_scenario_out():
    assert slip('sensors.engine_speed.noise_rad_s=1') == slip()


@pytest.mark.parametrize('scenario', ['launch', 'upshift'])
def test_plates_that_lock_are_refused(scenario: str) -> None:
    with refused(ParameterError, 'clutch'):
        check_controller('pi', KnownSettings(load_scenario(scenario)))


SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
QUICK_S, LATE_S = 0.001, 0.02
"""Update times in s, within the period of 10 ms and beyond it."""


def timed(late: int, monkeypatch: pytest.MonkeyPatch) -> Subject:
    """Return the subject of trials with 100 updates, `late` of which are late."""
    subject = Subject('pi', SETTINGS.known, OutputMonitor())
    log = ClosedLoopLog(update_s=[LATE_S] * late + [QUICK_S] * (100 - late))
    monkeypatch.setattr('ddct_controllers.check.loops.closed_trial', lambda *_: log)
    subject.closed_loop = log
    return subject


@pytest.mark.parametrize('late', [0, 1, 4])
def test_a_twentieth_of_the_updates_may_be_late(
    late: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = update_time(timed(late, monkeypatch))
    assert found == 'median 1.000 ms, 95% within 1.000 ms, of 100 updates'


@pytest.mark.parametrize('late', [6, 50, 94, 99])
def test_more_late_updates_fail_however_quick_the_quickest_are(
    late: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(CheckFailedError, match='95% within 20.000 ms, of 100 updates: it must be'):
        update_time(timed(late, monkeypatch))


@pytest.mark.parametrize(('slow', 'further'), [(0, 0), (1, 1), (2, 2), (9, 2)])
def test_a_controller_that_seems_slow_has_up_to_two_further_trials(
    slow: int, further: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    subject = Subject('pi', SETTINGS.known, OutputMonitor())
    times_s = [LATE_S] * slow + [QUICK_S] * 10
    trials = iter([ClosedLoopLog(update_s=[each] * 100) for each in times_s])
    subject.closed_loop = next(trials)
    monkeypatch.setattr('ddct_controllers.check.loops.closed_trial', lambda *_: next(trials))
    with nullcontext() if slow <= further else pytest.raises(CheckFailedError, match='20.000 ms'):
        update_time(subject)
    assert len([*trials]) == len(times_s) - 1 - further


class ConstantRequest(Controller):
    """A controller that adds 10 N m of the clutch and 5 N m of the engine to the demand."""

    commands_engine = True

    def reset(self) -> None:
        pass

    def update(self, measurement: Any) -> Command:
        return Command(10.0, engine_torque=measurement.engine_torque + 5.0)


def test_a_scaled_trial_scales_what_the_controller_adds_and_leaves_the_drivers_demand() -> None:
    """A scale of 9.55, that of a unit, does not multiply the driver's demand."""
    controller: Any = ConstantRequest()
    log = closed_trial(SETTINGS.known, controller, scale=3.0)
    start = SETTINGS.scenario.control_start_step
    _, measured = log.measurements[start]
    assert measured.engine_torque > 100.0
    command = controller.update(measured)
    assert command.clutch_torque == pytest.approx(30.0)
    assert command.engine_torque == pytest.approx(measured.engine_torque + 15.0)
    plain: Any = ConstantRequest()
    closed_trial(SETTINGS.known, plain)
    assert plain.update(measured).engine_torque == measured.engine_torque + 5.0


def test_a_scaled_trial_without_a_request_has_the_drivers_demand() -> None:
    """The plant gets the driver's demand, whatever the scale."""

    class Idle(ConstantRequest):
        def update(self, measurement: Any) -> Command:
            return Command(0.0, engine_torque=measurement.engine_torque)

    once, scaled = (
        closed_trial(SETTINGS.known, Idle(), scale=scale).slip for scale in (1.0, 9.55)
    )
    np.testing.assert_allclose(scaled, once, rtol=1e-12, atol=1e-9)


@pytest.mark.parametrize(('factor', 'passes'), [(2.0, True), (1.0, True), (0.5, False)])
def test_a_request_moves_at_most_as_fast_as_the_actuator_of_the_car_follows(
    factor: float, passes: bool
) -> None:
    """3000 N m/s are below ten strokes of 350 N m per second, and above five."""
    scenario = load_scenario('thesis', {'actuator.bandwidth_factor': factor})
    subject = Subject('pi', KnownSettings(scenario), OutputMonitor())
    subject.closed_loop = ClosedLoopLog(request=[0.0, 30.0] * 100)
    if passes:
        assert '3000 N m per second' in rate(subject)
    else:
        with pytest.raises(CheckFailedError, match='more than 1750'):
            rate(subject)
