# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Engine, load, actuator, clutch and driveline of a run, wired as the graph wires their nodes."""

from typing import Any, NamedTuple, Protocol

from ddct_plant.base.timebase import time_of_step
from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.scenario.plant import (
    driveline_sensors,
    holding_torque,
    initial_state,
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


class TorqueActuator(Protocol):
    """Actuator of the plant: torque requests in, torque out."""

    def update(self, request: float) -> list[float]:
        """Return the torque in N m at 0, 1, ..., 10 ms, (11,), and accept a request in N m."""


class Linear:
    """The linear clutch, as part of the plant."""

    torques = ('clutch_torque',)
    """Names of the torques in `reply` that the driveline integrates, in the order of its
    `step`."""

    def __init__(self, settings: RunSettings) -> None:
        self._clutch = linear_clutch(settings)

    def reply(
        self, step: int, actuator_torque: list[float], outputs: DrivelineOutputs
    ) -> dict[str, Any]:
        """Return the signals of the clutch for the period of t_k, by name."""
        return {'clutch_torque': self._clutch.transmit(actuator_torque)}


class StickSlip:
    """The stick-slip clutch and the friction at the wheels, as parts of the plant."""

    torques = ('clutch_torque', 'clutch_static_torque', 'holding_torque')

    def __init__(self, settings: RunSettings) -> None:
        self._clutch = stick_slip_clutch(settings)
        self._holding = holding_torque(settings)

    def reply(
        self, step: int, actuator_torque: list[float], outputs: DrivelineOutputs
    ) -> dict[str, Any]:
        """Return the signals for the period of t_k and the phase signals at t_k, by name."""
        assert outputs.friction_work is not None
        clutch = self._clutch.reply(
            step, actuator_torque, outputs.slip_speed, outputs.friction_work
        )
        return {
            'clutch_torque': clutch.kinetic,
            'clutch_static_torque': clutch.static,
            'clutch_temperature': clutch.temperature_c,
            'holding_torque': self._holding.capacity(time_of_step(step)),
            'clutch_phase': outputs.clutch_phase,
            'friction_work': outputs.friction_work,
            'phase_events': outputs.phase_events,
        }


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
    ) -> dict[str, Any]:
        """Return the plant's signals of step k by name; both requests are in N m."""
        outputs = observation.true
        actuator_torque = self.actuator.update(torque_request)
        engine_torque = observation.delivered
        if engine_torque is None:
            engine_torque = self._engine.torque(step, engine_request, outputs.engine_speed)
        reply = {
            'joint_position': outputs.joint_position,
            'joint_speed': outputs.joint_speed,
            'joint_effort': outputs.joint_effort,
            'slip_speed': outputs.slip_speed,
            'vehicle_speed': outputs.vehicle_speed,
            'vehicle_accel': outputs.vehicle_accel,
            'torque_demand': observation.demand,
            'engine_torque': engine_torque,
            'load_torque': self._load.torque(outputs.vehicle_speed, time_of_step(step)),
            'torque_request': torque_request,
            'actuator_torque': actuator_torque,
            **self._friction.reply(step, actuator_torque, outputs),
        }
        if self._two_input:
            reply['engine_torque_request'] = engine_request
        if self._sensors is not None and self._estimate is not None:
            reply |= self._sensors.measure(step, outputs).signals
            reply |= self._estimate.measure(step, engine_torque).signals
        return reply

    @property
    def over(self) -> bool:
        """Whether the run ends with the present state, because the engine stalls or over-revs."""
        return bool(self._scenario.end_cause(self.driveline.engine_speed))

    def advance(self, reply: dict[str, Any]) -> None:
        """Integrate the driveline over one period with the torques of `reply`, in N m."""
        self.driveline.step(
            reply['engine_torque'],
            reply['load_torque'],
            *map(reply.__getitem__, self._friction.torques),
        )
