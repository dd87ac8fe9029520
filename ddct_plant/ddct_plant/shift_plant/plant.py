# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The plant of a shift: engine, load, two actuators, two clutches and the driveline."""

from typing import NamedTuple

from ddct_plant.base.timebase import time_of_step
from ddct_plant.models.clutch import Capacity
from ddct_plant.scenario.plant import (
    driveline_sensors,
    holding_torque,
    make_engine,
    make_load,
    torque_estimate,
)
from ddct_plant.scenario.rules.shift import gears_of
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.scenario.whole_plant import Observation
from ddct_plant.sensors.sensed import MeasuredSpeeds
from ddct_plant.shift.driveline import ShiftOutputs
from ddct_plant.shift.roles import OFF_GOING, ROLES
from ddct_plant.shift_plant.sides import (
    first_request,
    shift_driveline,
    shift_signals,
    side_actuator,
    side_clutch,
)
from ddct_plant.signals.signal import SignalValue

_OF_CLUTCH = (
    'torque_request',
    'actuator_torque',
    'clutch_torque',
    'clutch_static_torque',
    'clutch_temperature',
)
"""Names of the signals of a clutch and its actuator."""
_OF_REPLY = (
    *_OF_CLUTCH,
    *(f'{OFF_GOING}_{name}' for name in _OF_CLUTCH),
    'wheel_friction_work',
    'torque_demand',
    'engine_torque',
    'engine_torque_request',
    'load_torque',
    'holding_torque',
)
"""Names of the other signals of a step."""


class ShiftReply(NamedTuple):
    """The plant's answer to the requests of a step."""

    engine_torque: float
    """C_m in N m over the period."""
    load_torque: float
    """C_load of air and slope in N m over the period."""
    on_coming: Capacity
    """Capacities of the on-coming clutch over the period."""
    off_going: Capacity
    """Capacities of the off-going clutch over the period."""
    holding_torque: float
    """Capacity in N m of rolling resistance and brake over the period."""
    signals: dict[str, SignalValue]
    """Signals of the plant at this step, by name; those of the off-going side have a prefix."""


class ShiftPlant:
    """
    The plant of a shift, stepped by 10 ms.

    In each step a handover reads `outputs` and `demand`, the controller reads what `observe`
    returns; `reply` takes the requests of both, and `advance` integrates. Two runs with the same
    requests are the same to the last bit.
    """

    def __init__(self, settings: RunSettings, *, two_input: bool = False) -> None:
        """Start in the drive before the shift; `two_input`: the controller commands C_m."""
        self._scenario = settings.scenario
        self._two_input = two_input
        self._ratio = gears_of(settings.known.scenario).ratio
        self.driveline = shift_driveline(settings)
        self.first_request = first_request(settings, OFF_GOING)
        """Request of the off-going clutch before t_0 in N m, which keeps it locked."""
        self._engine, self._load = make_engine(settings), make_load(settings)
        self._holding = holding_torque(settings)
        self._sensors, self._estimate = driveline_sensors(settings), torque_estimate(settings)
        self._actuator, self._off_going_actuator = (
            side_actuator(settings, role) for role in ROLES
        )
        self._clutch, self._off_going_clutch = (side_clutch(settings, role) for role in ROLES)

    def demand(self, step: int) -> float:
        """Return the driver's demand of C_m in N m at step k."""
        return self._engine.demand(step)

    def outputs(self) -> ShiftOutputs:
        """Return the true outputs of both sides at the present step."""
        return self.driveline.outputs()

    def measured(self, step: int, outputs: ShiftOutputs) -> tuple[MeasuredSpeeds, float]:
        """
        Return the measurements of a handover at step k: speeds, and its slip in rad/s.

        No sensor is at the off-going shaft: in a run with sensors its speed is that of the
        on-coming shaft times the known ratio of the gears, which both are engaged in a handover.
        """
        true = outputs.driveline
        if self._sensors is None:
            return true, outputs.off_going.slip_speed
        speeds = self._sensors.measure(step, true)
        return speeds, speeds.engine_speed - self._ratio * speeds.shaft_speed

    def observe(
        self,
        step: int,
        outputs: ShiftOutputs,
        measured: MeasuredSpeeds,
        torque_cut: float = 0.0,
    ) -> Observation:
        """
        Return the observation of a controller of the on-coming clutch at step k.

        `measured` has the speeds of `measured` at this step. `torque_cut` in N m is taken off the
        driver's demand, within the engine's authority.
        """
        true = outputs.driveline
        demand = self._engine.demand(step) - torque_cut
        if self._two_input:
            return Observation(true, measured, demand, None, demand)
        torque = reported = self._engine.torque(step, demand, true.engine_speed)
        if self._estimate is not None:
            reported = self._estimate.measure(step, torque).engine_torque
        return Observation(true, measured, demand, torque, reported)

    def reply(
        self,
        step: int,
        outputs: ShiftOutputs,
        observation: Observation,
        torque_request: float,
        off_going_request: float,
        engine_request: float | None = None,
    ) -> ShiftReply:
        """Return torques and signals of step k; all requests are in N m."""
        true, other = outputs.driveline, outputs.off_going
        engine_torque = observation.delivered
        if engine_torque is None:
            engine_torque = self._engine.torque(
                step,
                observation.demand if engine_request is None else engine_request,
                true.engine_speed,
            )
        load_torque = self._load.torque(true.vehicle_speed, time_of_step(step))
        holding = self._holding.capacity(time_of_step(step))
        nodes = self._actuator.update(torque_request)
        other_nodes = self._off_going_actuator.update(off_going_request)
        assert true.friction_work is not None
        clutch = self._clutch.reply(step, nodes, true.slip_speed, true.friction_work)
        other_clutch = self._off_going_clutch.reply(
            step, other_nodes, other.slip_speed, other.friction_work
        )
        values = (
            *(torque_request, nodes, *clutch),
            *(off_going_request, other_nodes, *other_clutch),
            outputs.wheel_friction_work,
            self._engine.demand(step),
            engine_torque,
            engine_request,
            load_torque,
            holding,
        )
        signals = shift_signals(outputs)
        signals.update(zip(_OF_REPLY, values, strict=True))
        if self._sensors is not None and self._estimate is not None:
            if observation.delivered is None:
                self._estimate.measure(step, engine_torque)
            signals |= self._sensors.latest.signals
            signals |= self._estimate.latest.signals
        return ShiftReply(engine_torque, load_torque, clutch, other_clutch, holding, signals)

    @property
    def over(self) -> bool:
        """Whether the run ends with the present state, because the engine stalls or over-revs."""
        return bool(self._scenario.end_cause(self.driveline.engine_speed))

    def advance(self, reply: ShiftReply) -> None:
        """Integrate the driveline over one period with the torques of `reply`."""
        self.driveline.step(
            reply.engine_torque,
            reply.load_torque,
            *reply.on_coming[:2],
            reply.holding_torque,
            *reply.off_going[:2],
        )
