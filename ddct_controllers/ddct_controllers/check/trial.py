"""Try a controller: in the closed loop on the plant, or on measurements that are played to it."""

import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import wraps

import numpy as np

from ddct_controllers.architecture import make_architecture
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rad_s_from_rpm
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.scenario.whole_plant import WholePlant

RAMP_S = 0.8
"""From the slip speed at control start to zero."""
PROBE_S, AFTER_S = 0.5, 1.05
"""From control start to where something is changed, and from there to the end of a trial."""
PROBE_RPM = 50.0
PROBE_RAD_S = rad_s_from_rpm(PROBE_RPM)
"""Size of what is changed: 50 rpm of slip."""
GROWTH = 1.05
"""Factor from one half second to the next above which the error of a step grows."""
TIMED = 20
"""Updates after which a controller that is slower than its period is stopped."""
Change = Callable[[Measurement], Measurement]


@dataclass
class Heard:
    """What went in and out of a controller in the closed loop."""

    slip: list[float] = field(default_factory=list)
    """w_d in rad/s at every step."""
    measured: list[tuple[bool, Measurement]] = field(default_factory=list)
    """Whether feedback was on, and what was measured."""
    request: list[float] = field(default_factory=list)
    """What the clutch was asked at every step, in N m."""
    update_s: list[float] = field(default_factory=list)
    """Wall time of each update."""

    @property
    def too_slow(self) -> bool:
        """Whether most updates take longer than their period."""
        return len(self.update_s) >= TIMED and statistics.median(self.update_s) > PERIOD_S


def _listen(controller: Controller, heard: Heard, scale: float) -> None:
    """Write down what an object hears and how long it takes, and multiply its torques."""
    hold, update = controller.hold, controller.update

    @wraps(hold)
    def heard_hold(measurement: Measurement) -> None:
        heard.measured.append((False, measurement))
        hold(measurement)

    @wraps(update)
    def heard_update(measurement: Measurement) -> Command:
        heard.measured.append((True, measurement))
        started = time.perf_counter()
        command = update(measurement)
        heard.update_s.append(time.perf_counter() - started)
        return command if scale == 1.0 else _scaled(command, measurement, scale)

    # Wrapped in the object itself: errors still name its class and its lines.
    vars(controller).update(hold=heard_hold, update=heard_update)


def _scaled(command: Command, measurement: Measurement, scale: float) -> Command:
    demand, engine = measurement.engine_torque, command.engine_torque
    if engine is not None:
        engine = demand + scale * (engine - demand)
    return replace(command, clutch_torque=scale * command.clutch_torque, engine_torque=engine)


def more_slip(measurement: Measurement, by_rad_s: float = PROBE_RAD_S) -> Measurement:
    """Return a measurement with more slip."""
    return replace(measurement, engine_speed=measurement.engine_speed + by_rad_s)


def probe_step(settings: RunSettings) -> int:
    """Return the step at which trials change something."""
    return settings.scenario.control_start_step + round(PROBE_S / PERIOD_S)


def closed_trial(
    settings: RunSettings,
    controller: Controller,
    *,
    reference_step: bool = False,
    scale: float = 1.0,
) -> Heard:
    """
    Run a new object, which stays wrapped, on the plant; its slip reference falls to zero.

    `reference_step` lowers the reference by PROBE_RAD_S at the probe step. Sensors of the scenario
    are left out: trials are told apart by less than their noise. Raise what the controller raises,
    as a DdctError that names it.
    """
    heard = Heard()
    exact = replace(settings, scenario=replace(settings.scenario, sensors=None))
    plant = WholePlant(exact, two_input=controller.commands_engine)
    _listen(controller, heard, scale)
    architecture = make_architecture(settings, controller)
    start, probe = settings.scenario.control_start_step, probe_step(settings)
    from_speed = 0.0
    for step in range(probe + round(AFTER_S / PERIOD_S) + 1):
        observation = plant.observe(step)
        if step <= start:
            from_speed = observation.true.slip_speed
        ahead = np.arange(step, step + controller.preview_steps + 1)
        left = 1.0 - np.maximum(ahead - start, 0) * PERIOD_S / RAMP_S
        speeds = from_speed * np.maximum(left, 0.0)
        if reference_step:
            speeds -= PROBE_RAD_S * (ahead >= probe)
        rates = np.where((left > 0.0) & (ahead >= start), -from_speed / RAMP_S, 0.0)
        measurement = Measurement.of_plant(step, observation, speeds.tolist(), rates.tolist())
        request = architecture.update(measurement)
        heard.slip.append(observation.true.slip_speed)
        heard.request.append(request.torque)
        if heard.too_slow:
            break
        plant.advance(plant.reply(step, observation, request.torque, request.engine_torque))
    return heard


def played(
    controller: Controller,
    measured: Sequence[tuple[bool, Measurement]],
    change: Change = lambda measurement: measurement,
    from_step: int = 0,
    to_step: int = 10**9,
) -> np.ndarray:
    """
    Return the torques (steps, 2) in N m that are asked of clutch and engine, the latter 0 if none.

    `measured` is what the controller is given, with `change` in steps `from_step` to `to_step`
    less 1.
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
    """How slip answers a step of its reference in the closed loop."""

    followed: float
    """Share of the step after 1 s."""
    diverges: bool
    """Whether the run, or its answer to the step, ends further off than it began."""


def step_response(
    settings: RunSettings,
    make: Callable[[], Controller],
    scale: float = 1.0,
    plain: Heard | None = None,
) -> StepResponse:
    """
    Return the difference that a step of the reference makes, with all torques times `scale`.

    `plain` is the run without the step, if it is there already. A loop that the controller itself
    gives up, with a DdctError, counts as one that diverges.
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
    wanted = [measurement.slip_reference[0] for _, measurement in plain.measured]
    error = np.array(plain.slip) - wanted
    runs_away = np.abs(error[probe + half :]).max() > abs(plain.slip[start])
    return StepResponse(float(response[round(1.0 / PERIOD_S)]), bool(grows or runs_away))
