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
from ddct_plant.sensors.sensed import Seen


class TorqueActuator(Protocol):
    """What turns torque requests into torque."""

    def update(self, request: float) -> list[float]:
        """Return the torque in N m at 0, 1, ..., 10 ms, (11,), and take the next request in."""


class Linear:
    """The linear clutch in the loop."""

    torques = ('clutch_torque',)
    """What the driveline integrates of `reply`."""

    def __init__(self, settings: RunSettings) -> None:
        self._clutch = linear_clutch(settings)

    def reply(
        self, step: int, actuator_torque: list[float], now: DrivelineOutputs
    ) -> dict[str, Any]:
        """Return the signals by name that answer t_k."""
        return {'clutch_torque': self._clutch.transmit(actuator_torque)}


class StickSlip:
    """The clutch that sticks in the loop, and what holds the wheels."""

    torques = ('clutch_torque', 'clutch_static_torque', 'holding_torque')

    def __init__(self, settings: RunSettings) -> None:
        self._clutch = stick_slip_clutch(settings)
        self._holding = holding_torque(settings)

    def reply(
        self, step: int, actuator_torque: list[float], now: DrivelineOutputs
    ) -> dict[str, Any]:
        """Return the signals by name that answer t_k, and the phases of the period before."""
        assert now.friction_work is not None
        clutch = self._clutch.reply(step, actuator_torque, now.slip_speed, now.friction_work)
        return {
            'clutch_torque': clutch.kinetic,
            'clutch_static_torque': clutch.static,
            'clutch_temperature': clutch.temperature_c,
            'holding_torque': self._holding.capacity(time_of_step(step)),
            'clutch_phase': now.clutch_phase,
            'friction_work': now.friction_work,
            'phase_events': now.phase_events,
        }


class PlantSight(NamedTuple):
    """The plant at t_k, and what control is told of it."""

    now: DrivelineOutputs
    """The truth."""
    seen: Seen
    """What controller and reference see of it: the truth, or what the sensors say."""
    demand: float
    """C_m in N m that the driver asks for."""
    delivered: float | None
    """C_m in N m over the coming period; None while a request of the controller is due."""
    told: float
    """C_m in N m as the controller is told it: the demand if it commands C_m."""


class WholePlant:
    """The plant of a run: `look` at it, `reply` to what control asks, `advance` by a period."""

    def __init__(self, settings: RunSettings, *, two_input: bool) -> None:
        """Start in the run's initial state; `two_input` is whether C_m is commanded."""
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

    def look(self, step: int) -> PlantSight:
        """Return what there is to be seen at step k."""
        now = self.driveline.outputs()
        seen = now if self._sensors is None else self._sensors.measure(step, now)
        demand = self._engine.demand(step)
        # A controller that commands the engine is told the demand, any other what is delivered.
        if self._two_input:
            return PlantSight(now, seen, demand, None, demand)
        torque = told = self._engine.torque(step, speed=now.joint_speed[0])
        if self._estimate is not None:
            told = self._estimate.measure(step, torque).sensed_engine_torque
        return PlantSight(now, seen, demand, torque, told)

    def reply(
        self, step: int, sight: PlantSight, torque_request: float, engine_request: float | None
    ) -> dict[str, Any]:
        """Return the plant's signals of step k by name; both requests are in N m."""
        now = sight.now
        actuator_torque = self.actuator.update(torque_request)
        engine_torque = sight.delivered
        if engine_torque is None:
            engine_torque = self._engine.torque(step, engine_request, now.joint_speed[0])
        reply = {
            'joint_position': now.joint_position,
            'joint_speed': now.joint_speed,
            'joint_effort': now.joint_effort,
            'slip_speed': now.slip_speed,
            'vehicle_speed': now.vehicle_speed,
            'vehicle_accel': now.vehicle_accel,
            'torque_demand': sight.demand,
            'engine_torque': engine_torque,
            'load_torque': self._load.torque(now.vehicle_speed, time_of_step(step)),
            'torque_request': torque_request,
            'actuator_torque': actuator_torque,
            **self._friction.reply(step, actuator_torque, now),
        }
        if self._two_input:
            reply['engine_torque_request'] = engine_request
        if self._sensors is not None and self._estimate is not None:
            reply |= self._sensors.measure(step, now)._asdict()
            reply |= self._estimate.measure(step, engine_torque)._asdict()
        return reply

    @property
    def over(self) -> bool:
        """Whether the engine's speed ends the run with the present state."""
        return bool(self._scenario.end_cause(self.driveline.engine_speed))

    def advance(self, reply: dict[str, Any]) -> None:
        """Integrate the driveline over the period that `reply` answered."""
        self.driveline.step(
            reply['engine_torque'],
            reply['load_torque'],
            *map(reply.__getitem__, self._friction.torques),
        )
