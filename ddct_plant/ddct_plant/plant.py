# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The plant of a run, wired as the graph wires its nodes: a launch has one clutch, a shift two."""

from typing import Any, NamedTuple, Protocol

from ddct_plant.base.timebase import time_of_step
from ddct_plant.models.driveline import DrivelineOutputs, OffGoingOutputs
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.plant import (
    driveline_sensors,
    friction_clutch,
    holding_torque,
    linear_clutch,
    make_actuator,
    make_driveline,
    make_engine,
    make_load,
    torque_estimate,
)
from ddct_plant.scenario.rules.shift import gears_of
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.sensors.sensed import MeasuredSpeeds
from ddct_plant.shift.roles import OFF_GOING, ROLES
from ddct_plant.signals.topic import SignalValue

_OF_SIDE = (
    'torque_request',
    'actuator_torque',
    'clutch_torque',
    'clutch_static_torque',
    'clutch_temperature',
)
"""Names of the signals of a clutch and its actuator; with the linear clutch the first three."""


class Tick(NamedTuple):
    """The plant at t_k before any reply to it, as a handover reads it."""

    step: int
    """Step k."""
    true: DrivelineOutputs
    """True outputs of the driveline at t_k."""
    measured: MeasuredSpeeds
    """Speeds that controller and reference receive: those of the sensors, true without sensors."""
    off_going_slip: float | None
    """Measured slip speed of the off-going clutch in rad/s; None without a shift."""
    demand: float
    """Driver's demand of C_m in N m."""


class Observation(NamedTuple):
    """The plant at t_k with its engine torque, as a controller receives it."""

    tick: Tick
    """The plant before any reply."""
    requested: float | None
    """C_m in N m that a handover requests, the demand less its cut; None without a handover."""
    delivered: float | None
    """C_m in N m over the coming period; None while it depends on the controller's request."""
    engine_torque: float
    """C_m in N m that the controller receives: what is requested of the engine if it commands C_m
    itself, else the delivered torque or its estimate."""


class PlantReply(NamedTuple):
    """The plant's answer to the requests of a step."""

    engine_torque: float
    """C_m in N m over the period."""
    load_torque: float
    """C_load in N m over the period; with sticking plates that of air and slope."""
    friction_torques: tuple[Any, ...]
    """Torques in N m of the clutches and of the friction at the wheels, in the order of the
    driveline's `step`."""
    signals: dict[str, SignalValue]
    """Signals of the plant at this step, by name; those of the off-going side have a prefix."""


class TorqueActuator(Protocol):
    """Actuator of the plant: torque requests in, torque out."""

    def update(self, request: float) -> list[float]:
        """Return the torque in N m at 0, 1, ..., 10 ms, (11,), and accept a request in N m."""


class LinearSide:
    """The one side of a plant with the linear clutch."""

    def __init__(self, settings: RunSettings, actuator: TorqueActuator) -> None:
        self.actuator = actuator
        self._clutch = linear_clutch(settings)
        self.names = _OF_SIDE[:3]
        """Names of the signals."""

    def reply(
        self, step: int, request: float, outputs: DrivelineOutputs | OffGoingOutputs
    ) -> tuple[tuple[Any, ...], tuple[SignalValue, ...]]:
        """Return the transmitted torque for the period of t_k, and the values of `names`."""
        actuator_torque = self.actuator.update(request)
        torque = self._clutch.transmit(actuator_torque)
        return (torque,), (request, actuator_torque, torque)


class StickSlipSide:
    """One side of a plant with sticking plates: an actuator and its clutch."""

    def __init__(self, settings: RunSettings, role: str, actuator: TorqueActuator) -> None:
        self.actuator = actuator
        self._clutch = friction_clutch(settings, role)
        prefix = f'{OFF_GOING}_' if role == OFF_GOING else ''
        self.names = tuple(f'{prefix}{name}' for name in _OF_SIDE)
        """Names of the signals."""

    def reply(
        self, step: int, request: float, outputs: DrivelineOutputs | OffGoingOutputs
    ) -> tuple[tuple[Any, ...], tuple[SignalValue, ...]]:
        """Return the capacities for the period of t_k, and the values of `names`."""
        actuator_torque = self.actuator.update(request)
        assert outputs.friction_work is not None
        capacity = self._clutch.reply(
            step, actuator_torque, outputs.slip_speed, outputs.friction_work
        )
        return capacity[:2], (request, actuator_torque, *capacity)


class Plant:
    """
    The plant of a run, stepped by 10 ms: `tick`, `observe`, `reply`, `advance`.

    A handover reads the tick, a controller what `observe` returns; `reply` takes the requests of
    both, and `advance` integrates. Two runs with the same requests are the same to the last bit.
    """

    def __init__(self, settings: RunSettings, *, two_input: bool = False) -> None:
        """Start in the run's initial state; `two_input`: the controller commands C_m."""
        self._scenario = settings.scenario
        self._two_input = two_input
        initial = initial_state(settings)
        self.driveline = make_driveline(settings, initial)
        self._engine, self._load = make_engine(settings), make_load(settings)
        self._holding = holding_torque(settings) if settings.stick_slip else None
        self._sensors, self._estimate = driveline_sensors(settings), torque_estimate(settings)
        self._ratio = gears_of(settings.known.scenario).ratio if settings.shift else None
        actuators = [make_actuator(settings, side.torque_request) for side in initial.sides]
        self.sides: list[LinearSide | StickSlipSide] = (
            [StickSlipSide(settings, *side) for side in zip(ROLES, actuators, strict=False)]
            if settings.stick_slip
            else [LinearSide(settings, actuators[0])]
        )
        """Actuator and clutch of each side, in a shift the on-coming one first."""

    def tick(self, step: int) -> Tick:
        """
        Return the true outputs and the measurements at step k.

        No sensor is at the off-going shaft: in a run with sensors its speed is that of the
        on-coming shaft times the known ratio of the gears, since a handover has both engaged.
        """
        true = self.driveline.outputs()
        demand, off_going = self._engine.demand(step), true.off_going
        off_going_slip = None if off_going is None else off_going.slip_speed
        if self._sensors is None:
            return Tick(step, true, true, off_going_slip, demand)
        measured = self._sensors.measure(step, true)
        if self._ratio is not None:
            off_going_slip = measured.engine_speed - self._ratio * measured.shaft_speed
        return Tick(step, true, measured, off_going_slip, demand)

    def observe(self, tick: Tick, torque_cut: float | None = None) -> Observation:
        """
        Return what a controller of the on-coming clutch receives at a tick.

        `torque_cut` in N m is what a handover takes off the driver's demand, within the engine's
        authority; None without a handover.
        """
        requested = None if torque_cut is None else tick.demand - torque_cut
        # A controller that commands the engine receives the request, others the delivered torque.
        if self._two_input:
            received = tick.demand if requested is None else requested
            return Observation(tick, requested, None, received)
        torque = reported = self._engine.torque(tick.demand, requested, tick.true.engine_speed)
        if self._estimate is not None:
            reported = self._estimate.measure(tick.step, torque).engine_torque
        return Observation(tick, requested, torque, reported)

    def reply(
        self,
        observation: Observation,
        torque_request: float,
        engine_request: float | None = None,
        off_going_request: float = 0.0,
    ) -> PlantReply:
        """Return torques and signals of the step of an observation; all requests are in N m."""
        step, true = observation.tick.step, observation.tick.true
        engine_torque = observation.delivered
        if engine_torque is None:
            requested = observation.requested if engine_request is None else engine_request
            demand = observation.tick.demand
            engine_torque = self._engine.torque(demand, requested, true.engine_speed)
        load_torque = self._load.torque(true.vehicle_speed, time_of_step(step))
        signals, side = true.signals, self.sides[0]
        torques, values = side.reply(step, torque_request, true)
        signals.update(zip(side.names, values, strict=True))
        if true.off_going is not None:
            side = self.sides[1]
            of_other, values = side.reply(step, off_going_request, true.off_going)
            torques += of_other
            signals.update(zip(side.names, values, strict=True))
        if self._holding is not None:
            holding = signals['holding_torque'] = self._holding.capacity(time_of_step(step))
            torques = holding, *torques
        signals['torque_demand'] = observation.tick.demand
        signals['engine_torque'] = engine_torque
        signals['engine_torque_request'] = engine_request
        signals['load_torque'] = load_torque
        if self._sensors is not None and self._estimate is not None:
            if observation.delivered is None:
                self._estimate.measure(step, engine_torque)
            signals |= self._sensors.latest.signals
            signals |= self._estimate.latest.signals
        return PlantReply(engine_torque, load_torque, torques, signals)

    @property
    def over(self) -> bool:
        """Whether the run ends with the present state, because the engine stalls or over-revs."""
        return bool(self._scenario.end_cause(self.driveline.engine_speed))

    def advance(self, reply: PlantReply) -> None:
        """Integrate the driveline over one period with the torques of `reply`."""
        self.driveline.step(reply.engine_torque, reply.load_torque, *reply.friction_torques)
