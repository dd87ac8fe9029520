# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Engine, load, actuator, clutch and driveline of a run, wired as the graph wires their nodes."""

from typing import Any, NamedTuple, Protocol

from ddct_plant.base.timebase import time_of_step
from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.plant import (
    driveline_sensors,
    holding_torque,
    linear_clutch,
    make_actuator,
    make_driveline,
    make_engine,
    make_load,
    stick_slip_clutch,
    torque_estimate,
)
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.sensors.sensed import MeasuredSpeeds
from ddct_plant.signals.signal import SignalValue


class TorqueActuator(Protocol):
    """Actuator of the plant: torque requests in, torque out."""

    def update(self, request: float) -> list[float]:
        """Return the torque in N m at 0, 1, ..., 10 ms, (11,), and accept a request in N m."""


class ClutchReply(NamedTuple):
    """The clutch's answer to the torque of the actuator over a period."""

    torques: tuple[Any, ...]
    """Torques in N m that the driveline integrates, in the order of its `step`."""
    signals: dict[str, SignalValue]
    """Signals of the clutch and of the friction at the wheels, by name."""


class Linear:
    """The linear clutch, as part of the plant."""

    def __init__(self, settings: RunSettings) -> None:
        self._clutch = linear_clutch(settings)

    def reply(
        self, step: int, actuator_torque: list[float], outputs: DrivelineOutputs
    ) -> ClutchReply:
        """Return the transmitted torque for the period of t_k."""
        torque = self._clutch.transmit(actuator_torque)
        return ClutchReply((torque,), {'clutch_torque': torque})


class StickSlip:
    """The stick-slip clutch and the friction at the wheels, as parts of the plant."""

    def __init__(self, settings: RunSettings) -> None:
        self._clutch = stick_slip_clutch(settings)
        self._holding = holding_torque(settings)

    def reply(
        self, step: int, actuator_torque: list[float], outputs: DrivelineOutputs
    ) -> ClutchReply:
        """Return the capacities for the period of t_k, and the temperature."""
        assert outputs.friction_work is not None
        clutch = self._clutch.reply(
            step, actuator_torque, outputs.slip_speed, outputs.friction_work
        )
        holding = self._holding.capacity(time_of_step(step))
        return ClutchReply(
            (clutch.kinetic, clutch.static, holding),
            {
                'clutch_torque': clutch.kinetic,
                'clutch_static_torque': clutch.static,
                'clutch_temperature': clutch.temperature_c,
                'holding_torque': holding,
            },
        )


class PlantReply(NamedTuple):
    """The plant's answer to the requests of a step."""

    engine_torque: float
    """C_m in N m over the period."""
    load_torque: float
    """C_load in N m over the period."""
    clutch_torques: tuple[Any, ...]
    """Torques in N m of the clutch and of the friction at the wheels, as `ClutchReply` has."""
    signals: dict[str, SignalValue]
    """Signals of the plant at this step, by name."""


class Observation(NamedTuple):
    """State of the plant at t_k, and the measurements that controller and reference receive."""

    true: DrivelineOutputs
    """True outputs of the driveline at t_k."""
    measured: MeasuredSpeeds
    """Speeds that controller and reference receive: those of the sensors, true without sensors."""
    demand: float
    """Driver's demand of C_m in N m."""
    delivered: float | None
    """C_m in N m over the coming period; None while it depends on the controller's request."""
    engine_torque: float
    """C_m in N m that the controller receives: the demand if it commands C_m itself, else the
    delivered torque or its estimate."""


class WholePlant:
    """The plant of a run: `observe` it, `reply` to the requests, `advance` by a period."""

    def __init__(self, settings: RunSettings, *, two_input: bool) -> None:
        """Start in the run's initial state; `two_input`: the controller commands C_m."""
        self._scenario = settings.scenario
        self._two_input = two_input
        initial = initial_state(settings)
        self.driveline = make_driveline(settings, initial)
        self._engine = make_engine(settings)
        self._load = make_load(settings)
        self._sensors = driveline_sensors(settings)
        self._estimate = torque_estimate(settings)
        self.actuator: TorqueActuator = make_actuator(settings, initial)
        self._friction = StickSlip(settings) if settings.stick_slip else Linear(settings)

    def observe(self, step: int) -> Observation:
        """Return the true outputs and the measurements at step k."""
        outputs = self.driveline.outputs()
        measured = outputs if self._sensors is None else self._sensors.measure(step, outputs)
        demand = self._engine.demand(step)
        # A controller that commands the engine receives the demand, others the delivered torque.
        if self._two_input:
            return Observation(outputs, measured, demand, None, demand)
        torque = reported = self._engine.torque(step, speed=outputs.engine_speed)
        if self._estimate is not None:
            reported = self._estimate.measure(step, torque).engine_torque
        return Observation(outputs, measured, demand, torque, reported)

    def reply(
        self,
        step: int,
        observation: Observation,
        torque_request: float,
        engine_request: float | None,
    ) -> PlantReply:
        """Return torques and signals of step k; both requests are in N m."""
        outputs = observation.true
        actuator_torque = self.actuator.update(torque_request)
        engine_torque = observation.delivered
        if engine_torque is None:
            engine_torque = self._engine.torque(step, engine_request, outputs.engine_speed)
        load_torque = self._load.torque(outputs.vehicle_speed, time_of_step(step))
        clutch = self._friction.reply(step, actuator_torque, outputs)
        signals: dict[str, SignalValue] = {
            **outputs._asdict(),
            'torque_demand': observation.demand,
            'engine_torque': engine_torque,
            'load_torque': load_torque,
            'torque_request': torque_request,
            'engine_torque_request': engine_request,
            'actuator_torque': actuator_torque,
            **clutch.signals,
        }
        if self._sensors is not None and self._estimate is not None:
            if observation.delivered is None:
                self._estimate.measure(step, engine_torque)
            signals |= self._sensors.latest.signals
            signals |= self._estimate.latest.signals
        return PlantReply(engine_torque, load_torque, clutch.torques, signals)

    @property
    def over(self) -> bool:
        """Whether the run ends with the present state, because the engine stalls or over-revs."""
        return bool(self._scenario.end_cause(self.driveline.engine_speed))

    def advance(self, reply: PlantReply) -> None:
        """Integrate the driveline over one period with the torques of `reply`."""
        self.driveline.step(reply.engine_torque, reply.load_torque, *reply.clutch_torques)
