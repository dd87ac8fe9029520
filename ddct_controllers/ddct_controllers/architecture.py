# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Control architectures of the thesis: the torque request as open loop plus feedback."""

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from ddct_controllers.closing import ClosingStage
from ddct_controllers.command_check import checked_command
from ddct_controllers.handover.torque_phase import TorquePhase
from ddct_controllers.interface import Command, Controller, Measurement, Status
from ddct_controllers.places import place_of_failure
from ddct_controllers.registry import Chosen, make_controller, separately
from ddct_plant.base.errors import (
    FOREIGN_FAILURES,
    DdctError,
    ForeignError,
    ParameterError,
    require_number,
)
from ddct_plant.base.options import require_known
from ddct_plant.base.timebase import time_of_step
from ddct_plant.models.load import RoadLoad
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.settings import KnownSettings
from ddct_plant.shift.balance import WHOLE, OnComingShare
from ddct_plant.signals.gain_changes import GainRecord

_FEEDBACK_OFF = Command(0.0)


class TorqueRequest(NamedTuple):
    """Clutch torque request for one period, before saturation, and its parts."""

    torque: float
    """
    Sum of open loop and feedback in N m; the actuator cuts it off below zero.

    In a shift it is corrected by what the handover knows of the on-coming clutch.
    """
    status: Status
    """Pairs for `controller/status`: feedback, saturation, the controller's own, changed gains."""
    open_loop: float
    """Part of the torque without feedback in N m, that of the closing stage included."""
    closed_loop: float
    """Part of the torque that feedback gives, N m."""
    closing: float = 0.0
    """Share of the closing stage in `open_loop`, N m; 0 without one."""
    engine_torque: float | None = None
    """Request for C_m in N m; None when the controller does not command the engine."""

    @property
    def parts(self) -> dict[str, float]:
        """Parts of the torque in N m, by the names of the run's signals."""
        return {
            'open_loop_torque': self.open_loop,
            'closed_loop_torque': self.closed_loop,
            'closing_torque': self.closing,
        }


class AskedRequest(NamedTuple):
    """A request for one period without the feedback, for which the controller is asked."""

    measurement: Measurement
    """What the controller receives, with the architecture's two torques."""
    on: bool
    """Whether feedback is on; else the controller passes the period in `hold`."""
    on_coming: OnComingShare
    """Share of the clutch in the open loop."""
    open_loop: float
    """Part of the torque without feedback in N m, that of the closing stage included."""
    closing: float
    """Share of the closing stage in `open_loop`, N m."""
    closing_status: Status
    """Pairs of the closing stage for `controller/status`."""


OpenLoop = Callable[[Measurement, float], float]
"""
Function from measurement and C_load in N m to the torque in N m that is independent of the slip.
"""


class Architecture:
    """
    C_f = open loop + feedback; feedback is off until its first step.

    The open loop takes the measurement, and C_load computed from V_x and the slope. A closing
    stage, if there is one, adds to it and switches feedback off while it is closed.
    """

    def __init__(
        self,
        open_loop: OpenLoop,
        load: RoadLoad,
        controller: Controller,
        feedback_start_step: int,
        closing: ClosingStage | None = None,
        torque_phase: TorquePhase | None = None,
    ) -> None:
        """
        Take `controller` as the feedback from step `feedback_start_step` on.

        A shift has a `torque_phase`, in which the share of the open loop is below 1.
        """
        self._open_loop = open_loop
        self._load = load
        self._controller = controller
        self._name = f'controller {controller.registered_name or type(controller).__name__!r}'
        self._start_step = feedback_start_step
        self._closing = closing
        self._torque_phase = torque_phase
        self._last_request = self._engine_deviation = 0.0
        self._changed_gains = GainRecord()

    def change_gains(self, gains: Mapping[str, float]) -> None:
        """
        Change gains of the controller, by name, from the next update on: all of them or none.

        From that update on the status has the latest change of each. Raise ParameterError for a
        name that the controller's `gains` lack, or for a value that it does not take.
        """
        before = self._controller.gains()
        require_known(gains, before, 'gain')
        for name, value in gains.items():
            require_number(name, value)
        self._changed_gains.announce(gains, before)
        try:
            for name, value in gains.items():
                self._controller.set_gain(name, value)
        except ParameterError:
            for name, value in before.items():
                self._controller.set_gain(name, value)
            raise

    def update(self, measurement: Measurement, on_coming: OnComingShare = WHOLE) -> TorqueRequest:
        """
        Return the request for the period that starts at the measurement's step.

        `on_coming` has the share of the open loop that the on-coming clutch of a shift carries;
        below 1 feedback is off. What is known of the clutch corrects the request, and the
        controller has a clutch as requested.
        """
        return self.answered(self.ask(measurement, on_coming))

    def ask(self, measurement: Measurement, on_coming: OnComingShare = WHOLE) -> AskedRequest:
        """Return what the controller is asked, as `update` does it, with all but its answer."""
        self._changed_gains.update(self._controller.gains, measurement.step)
        share = on_coming.share
        load_torque = self._load.torque(measurement.vehicle_speed, time_of_step(measurement.step))
        open_loop = share * self._open_loop(measurement, load_torque)
        on = measurement.step >= self._start_step and share == 1.0
        closing: Status = ()
        added = 0.0
        if self._closing:
            added = self._closing.update(
                measurement, load_torque, open_loop, self._last_request, feedback_on=on
            )
            open_loop += added
            on = on and not self._closing.closed
            closing = self._closing.status
        measurement = measurement.within(load_torque, open_loop)
        return AskedRequest(measurement, on, on_coming, open_loop, added, closing)

    def answered(self, asked: AskedRequest) -> TorqueRequest:
        """Return the request for the period, with the answer of the controller."""
        measurement, on, on_coming, open_loop, added, closing = asked
        whole = on_coming.share == 1.0
        command = self._command(measurement, on) if whole else self._handover(measurement)
        torque = self._last_request = open_loop + command.clutch_torque
        if on and command.engine_torque is not None:
            self._engine_deviation = command.engine_torque - measurement.engine_torque
        request = on_coming.request(torque)
        return TorqueRequest(
            request,
            (
                ('feedback', 'on' if on else 'held off'),
                ('saturated', 'true' if request < 0.0 else 'false'),
                *closing,
                *command.status,
                *self._changed_gains.pairs,
            ),
            open_loop,
            command.clutch_torque,
            added,
            command.engine_torque,
        )

    def _command(self, measurement: Measurement, on: bool) -> Command:
        """Return the controller's command; raise DdctError that names it for any error."""
        try:
            if on:
                command = self._controller.update(measurement)
                return checked_command(self._controller, self._name, command, measurement.step)
            self._controller.hold(measurement)
            return self._feedback_off(measurement)
        except DdctError:
            raise
        except np.linalg.LinAlgError as error:  # the numbers of a loop that diverges
            raise DdctError(
                f'{self._name}: it cannot go on at step {measurement.step} ({error}): the loop '
                'diverges in this scenario, or its options do not suit it'
            ) from error
        except FOREIGN_FAILURES as error:
            place = place_of_failure(self._controller, error)
            raise ForeignError(
                f'{self._name}: it failed at step {measurement.step} ({type(error).__name__}: '
                f'{error}, in {place}): mend the controller'
            ) from error

    def _handover(self, measurement: Measurement) -> Command:
        """Return the command of a period in which the off-going clutch carries torque."""
        assert self._torque_phase is not None
        self._command(self._torque_phase.measured(measurement), on=False)
        return self._feedback_off(measurement)

    def _feedback_off(self, measurement: Measurement) -> Command:
        """Return no clutch torque; C_m is the driver's demand, or returns to it."""
        if not self._controller.commands_engine:
            return _FEEDBACK_OFF
        engine = measurement.engine_torque
        if self._closing and self._closing.closed:
            engine += self._closing.engine_share * self._engine_deviation
        return Command(0.0, engine_torque=engine)


def make_architecture(settings: KnownSettings, controller: Controller) -> Architecture:
    """
    Build the run's architecture around `controller`, from the known settings.

    In `detailed` feedback starts at the scenario's `control_start_s`, in a shift with the share 1
    of its handover, in the other architectures at t = 0.
    """
    scenario = settings.scenario
    static = StaticTorque(scenario.controlled_driveline, scenario.equilibrium)
    closing = scenario.closing
    return Architecture(
        _make_open_loop(settings, static),
        RoadLoad(scenario.load, scenario.vehicle, scenario.slope),
        controller,
        scenario.control_start_step if settings.detailed and not settings.shift else 0,
        ClosingStage(closing, static, closing.most_request(scenario.friction))
        if closing
        else None,
        TorquePhase(settings) if settings.shift else None,
    )


class LoopNeeds(NamedTuple):
    """What the nodes around a controller have to know of it."""

    commands_engine: bool
    preview_steps: int


def loop_needs(chosen: Chosen, settings: KnownSettings) -> LoopNeeds:
    """Build a controller and its architecture for a run, and return what they need; else raise."""

    def work(chosen: Chosen) -> LoopNeeds:
        controller = make_controller(chosen, settings)
        make_architecture(settings, controller)
        return LoopNeeds(controller.commands_engine, controller.preview_steps)

    return separately(chosen, work)


def _make_open_loop(settings: KnownSettings, static: StaticTorque) -> OpenLoop:
    """Return C_fOL (Section 1.4.5.1), the feedforward (1.6.2), or nothing (1.6.1)."""
    scenario = settings.scenario
    if settings.detailed:
        return lambda m, load: static.torque(m.engine_torque, load, m.engine_speed, m.shaft_speed)
    if settings.architecture == 'base':
        return lambda m, load: 0.0
    # Only here: the other architectures need not wait for the imports of the design.
    from ddct_controllers.design.feedforward import Feedforward

    feedforward = Feedforward(scenario.driveline, scenario.actuator)
    return lambda m, load: feedforward.update(m.engine_torque, load)
