"""Control architectures of the thesis: how open loop and feedback make one torque request."""

from dataclasses import dataclass, replace
from numbers import Real
from typing import Protocol

from ddct_controllers.feedforward import Feedforward
from ddct_controllers.interface import Command, Controller, Measurement, Status
from ddct_plant.checks import require_finite
from ddct_plant.errors import DdctError
from ddct_plant.load import RoadLoad
from ddct_plant.parameters import DrivelineParameters
from ddct_plant.run_settings import RunSettings
from ddct_plant.static_torque import constant_slip_torque

_FEEDBACK_OFF = Command(0.0)


@dataclass(frozen=True, slots=True)
class TorqueRequest:
    """What the clutch is asked over one period, before saturation, and what it is made of."""

    torque: float
    """Sum of both parts in N m; the actuator cuts it off below zero."""
    status: Status
    """Pairs for `controller/status`: both parts, saturation, then the controller's own."""


class OpenLoop(Protocol):
    """The part of the request that does not depend on the slip."""

    def update(self, engine_torque: float, load_torque: float) -> float:
        """Return the torque in N m for C_m and C_load in N m of the coming period."""


class NoOpenLoop:
    """The base architecture has feedback alone (Section 1.6.1)."""

    def update(self, engine_torque: float, load_torque: float) -> float:
        """Return 0."""
        return 0.0


class StaticController:
    """C_fOL, always on in the detailed architecture (Section 1.4.5.1)."""

    def __init__(self, driveline: DrivelineParameters) -> None:
        """Take the driveline whose slip it keeps constant."""
        self._driveline = driveline

    def update(self, engine_torque: float, load_torque: float) -> float:
        """Return the torque that keeps the slip constant."""
        return constant_slip_torque(self._driveline, engine_torque, load_torque)


class Architecture:
    """
    C_f = open loop + feedback; feedback is held in reset until its first step.

    The open loop takes C_m, and C_load computed from V_x and the slope.
    """

    def __init__(
        self,
        open_loop: OpenLoop,
        load: RoadLoad,
        controller: Controller,
        feedback_start_step: int,
    ) -> None:
        """Wire `controller` as the feedback, on from `feedback_start_step`."""
        self._open_loop = open_loop
        self._load = load
        self._controller = controller
        self._start_step = feedback_start_step

    def update(self, measurement: Measurement) -> TorqueRequest:
        """Return the request for the period that starts at the measurement's step."""
        load_torque = self._load.torque(measurement.vehicle_speed)
        open_loop = self._open_loop.update(measurement.engine_torque, load_torque)
        if measurement.step >= self._start_step:
            feedback = 'on'
            command = _checked(self._controller.update(measurement), measurement.step)
        else:
            feedback = 'held in reset'
            self._controller.reset()
            command = _FEEDBACK_OFF
        torque = open_loop + command.clutch_torque
        return TorqueRequest(
            torque,
            (
                ('feedback', feedback),
                ('open_loop_torque_n_m', repr(open_loop)),
                ('closed_loop_torque_n_m', repr(command.clutch_torque)),
                ('saturated', 'true' if torque < 0.0 else 'false'),
                *command.status,
            ),
        )


def _checked(command: object, step: int) -> Command:
    """Return the command with a plain float as torque; raise DdctError for any other answer."""
    if not isinstance(command, Command):
        raise DdctError(
            f"the controller's answer at step {step} is of type {type(command).__name__}: "
            'return a ddct_controllers.interface.Command'
        )
    torque: object = command.clutch_torque
    source = f"the controller's torque at step {step}"
    if not isinstance(torque, Real):
        raise DdctError(f'{source} is {torque!r}: give a number in N m')
    number = require_finite(source, float(torque))
    return replace(command, clutch_torque=number)


def make_architecture(settings: RunSettings, controller: Controller) -> Architecture:
    """
    Build the run's architecture around `controller`.

    In `detailed` feedback starts at the scenario's `control_start_s`, in the others at t = 0.
    """
    scenario = settings.scenario
    return Architecture(
        _make_open_loop(settings),
        RoadLoad(scenario.load, scenario.vehicle),
        controller,
        scenario.control_start_step if settings.detailed else 0,
    )


def _make_open_loop(settings: RunSettings) -> OpenLoop:
    driveline = settings.scenario.driveline
    if settings.detailed:
        return StaticController(driveline)
    return NoOpenLoop() if settings.architecture == 'base' else Feedforward(driveline)
