# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Trials of a controller: in the closed loop on the plant, or on replayed measurements."""

import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import wraps
from typing import Any

import numpy as np

from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.loop import ClosedLoop
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rad_s_from_rpm
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from ddct_reference.slip_reference import NEVER, SlipReference

RAMP_S = 0.8
"""Duration in s of the reference's descent from the slip speed at control start to zero."""
PROBE_S, AFTER_S = 0.5, 1.05
"""Times in s: from control start to the probe step, and from there to the end of a trial."""
PROBE_RPM = 50.0
PROBE_RAD_S = rad_s_from_rpm(PROBE_RPM)
"""Change of slip or slip reference at the probe step in rad/s: 50 rpm."""
GROWTH = 1.05
"""Growth factor of a step's error per half second, above which the response diverges."""
TIMED = 20
"""Number of updates after which a controller that is slower than its period is stopped."""
Change = Callable[[Measurement], Measurement]


@dataclass
class ClosedLoopLog:
    """Signals at a controller in the closed loop, step by step."""

    slip: list[float] = field(default_factory=list)
    """Slip speed w_d in rad/s at every step."""
    measurements: list[tuple[bool, Measurement]] = field(default_factory=list)
    """Whether feedback was on, and the measurement, at every step."""
    request: list[float] = field(default_factory=list)
    """Clutch torque request of the architecture in N m at every step."""
    update_s: list[float] = field(default_factory=list)
    """Wall time of each update in s."""

    @property
    def too_slow(self) -> bool:
        """Whether most updates take longer than their period."""
        return len(self.update_s) >= TIMED and statistics.median(self.update_s) > PERIOD_S


def _log_calls(controller: Controller, log: ClosedLoopLog, scale: float) -> None:
    """Wrap an object's hold and update: log inputs and times, and scale its torques."""
    hold, update = controller.hold, controller.update

    @wraps(hold)
    def logged_hold(measurement: Measurement) -> None:
        log.measurements.append((False, measurement))
        hold(measurement)

    @wraps(update)
    def logged_update(measurement: Measurement) -> Command:
        log.measurements.append((True, measurement))
        started = time.perf_counter()
        command = update(measurement)
        log.update_s.append(time.perf_counter() - started)
        return command if scale == 1.0 else _scaled(command, measurement, scale)

    # Wrapped in the object itself: errors still name its class and its lines.
    vars(controller).update(hold=logged_hold, update=logged_update)


def _scaled(command: Command, measurement: Measurement, scale: float) -> Command:
    demand, engine = measurement.engine_torque, command.engine_torque
    if engine is not None:
        engine = demand + scale * (engine - demand)
    return replace(command, clutch_torque=scale * command.clutch_torque, engine_torque=engine)


def more_slip(measurement: Measurement, by_rad_s: float = PROBE_RAD_S) -> Measurement:
    """Return a measurement with the engine speed, and so the slip, higher by `by_rad_s`."""
    return replace(measurement, engine_speed=measurement.engine_speed + by_rad_s)


def probe_step(settings: KnownSettings) -> int:
    """Return the step at which trials change a signal."""
    return settings.scenario.control_start_step + round(PROBE_S / PERIOD_S)


class TrialReference(SlipReference):
    """Slip reference that falls to zero within RAMP_S, and is lower from a probe step on."""

    def __init__(self, start_step: int, preview_steps: int, probe_step: int) -> None:
        """Take the steps of the start and of the change by PROBE_RAD_S."""
        super().__init__(start_step, preview_steps)
        self._probe_step = probe_step
        self._from_speed = 0.0

    def _ahead(
        self, step: int, slip_speed: float, shaft_speed: float
    ) -> tuple[list[float], list[float]]:
        """Return the reference and its rate at steps k, k + 1, ..., k + P."""
        if step <= self.start_step:
            self._from_speed = slip_speed
        ahead = np.arange(step, step + self.preview_steps + 1)
        left = 1.0 - np.maximum(ahead - self.start_step, 0) * PERIOD_S / RAMP_S
        speeds = self._from_speed * np.maximum(left, 0.0)
        speeds -= PROBE_RAD_S * (ahead >= self._probe_step)
        falls = (left > 0.0) & (ahead >= self.start_step)
        rates = np.where(falls, -self._from_speed / RAMP_S, 0.0)
        return speeds.tolist(), rates.tolist()


def closed_trial(
    settings: KnownSettings,
    controller: Controller,
    *,
    reference_step: bool = False,
    scale: float = 1.0,
) -> ClosedLoopLog:
    """
    Run a new object, which stays wrapped, on the plant; its slip reference falls to zero.

    `reference_step` lowers the reference by PROBE_RAD_S at the probe step. Sensors of the scenario
    are left out: trials differ by less than their noise. Raise an error of the
    controller as a DdctError with its name.
    """
    log = ClosedLoopLog()
    exact = replace(settings, scenario=replace(settings.scenario, sensors=None))
    start, probe = settings.scenario.control_start_step, probe_step(settings)
    _log_calls(controller, log, scale)
    reference = TrialReference(start, controller.preview_steps, probe if reference_step else NEVER)
    loop = ClosedLoop(RunSettings(exact), controller, reference)
    for step in range(probe + round(AFTER_S / PERIOD_S) + 1):
        reply = loop.reply(step)
        signals: Any = reply.signals
        log.slip.append(signals['slip_speed'])
        log.request.append(signals['torque_request'])
        if log.too_slow:
            break
        loop.advance(reply)
    return log


def replay(
    controller: Controller,
    measured: Sequence[tuple[bool, Measurement]],
    change: Change = lambda measurement: measurement,
    from_step: int = 0,
    to_step: int = 10**9,
) -> np.ndarray:
    """
    Return the torques (steps, 2) in N m requested of clutch and engine, the latter 0 if none.

    The controller receives the measurements `measured`, with `change` applied in steps `from_step`
    to `to_step` less 1.
    """
    torques = np.zeros((len(measured), 2))
    for row, (on, measurement) in zip(torques, measured, strict=True):
        given = change(measurement) if from_step <= measurement.step < to_step else measurement
        if on:
            command = controller.update(given)
            row[:] = command.clutch_torque, command.engine_torque or 0.0
        else:
            controller.hold(given)
    return torques


@dataclass(frozen=True)
class StepResponse:
    """Response of the slip to a step of its reference in the closed loop."""

    followed: float
    """Share of the step that the slip has followed after 1 s, without unit."""
    diverges: bool
    """Whether the run, or the response to the step, ends with a larger error than at its start."""


def step_response(
    settings: KnownSettings,
    make: Callable[[], Controller],
    scale: float = 1.0,
    plain: ClosedLoopLog | None = None,
) -> StepResponse:
    """
    Return the response to a step of the reference, with all torques times `scale`.

    `plain` is the run without the step, if it exists already. A loop that the controller itself
    ends with a DdctError counts as one that diverges.
    """
    try:
        plain = plain or closed_trial(settings, make(), scale=scale)
        stepped = closed_trial(settings, make(), scale=scale, reference_step=True)
    except DdctError:
        return StepResponse(0.0, True)
    start, probe = settings.scenario.control_start_step, probe_step(settings)
    response = (np.array(plain.slip) - stepped.slip)[probe:] / PROBE_RAD_S
    missing = np.abs(1.0 - response)
    half = len(missing) // 2
    grows = missing[half:].max() > GROWTH * missing[:half].max()
    reference = [measurement.slip_reference[0] for _, measurement in plain.measurements]
    error = np.array(plain.slip) - reference
    runs_away = np.abs(error[probe + half :]).max() > abs(plain.slip[start])
    return StepResponse(float(response[round(1.0 / PERIOD_S)]), bool(grows or runs_away))
