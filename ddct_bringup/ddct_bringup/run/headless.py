"""
Run the closed loop without ROS: one step at a time, the same classes as the nodes.

    from ddct_bringup.run.headless import run_headless
    trajectory = run_headless(RunSettings(load_scenario('thesis')), 'pi')

The result equals that of the graph, in any process layout, to the last bit.
"""

import time
from typing import Any, Protocol

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.run_timing import RunTiming
from ddct_controllers.architecture import make_architecture
from ddct_controllers.interface import Controller, Measurement
from ddct_controllers.registry import make_controller
from ddct_plant.base.timebase import time_of_step
from ddct_plant.models.actuator import Actuator
from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.scenario.initial import initial_state
from ddct_plant.scenario.plant import (
    end_cause,
    holding_torque,
    linear_clutch,
    make_driveline,
    make_engine,
    make_load,
    stick_slip_clutch,
)
from ddct_plant.scenario.settings import RunSettings
from ddct_reference.factory import make_reference


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


class ClosedLoop:
    """Engine, load, driveline, reference, controller, actuator and clutch, wired as the graph."""

    def __init__(self, settings: RunSettings, controller: Controller) -> None:
        """Start in the run's initial state."""
        self._scenario = settings.scenario
        self._two_input = controller.commands_engine
        initial = initial_state(settings)
        self._driveline = make_driveline(settings, initial)
        self._engine = make_engine(settings)
        self._load = make_load(settings)
        self._reference = make_reference(settings, controller.preview_steps)
        self._architecture = make_architecture(settings, controller)
        self._actuator: TorqueActuator = Actuator(initial.torque_request)
        self._friction = StickSlip(settings) if settings.stick_slip else Linear(settings)
        self.update_time_us = 0.0
        """Wall time that the controller took for the last reply."""

    def reply(self, step: int) -> dict[str, Any]:
        """Return every signal of step k by its name in `Trajectory`; advances all but time."""
        now = self._driveline.outputs()
        demand = self._engine.demand(step)
        engine_speed = now.joint_speed[0]
        # A controller that commands the engine is told the demand, any other what is delivered.
        told = demand if self._two_input else self._engine.torque(step, speed=engine_speed)
        speeds, rates = self._reference.update(step, now.slip_speed, now.joint_speed[1])
        measurement = Measurement(
            step=step,
            engine_speed=engine_speed,
            shaft_speed=now.joint_speed[1],
            wheel_speed=now.joint_speed[2],
            vehicle_speed=now.vehicle_speed,
            engine_torque=told,
            slip_reference=speeds,
            slip_reference_rate=rates,
        )
        started = time.perf_counter()
        request = self._architecture.update(measurement)
        self.update_time_us = 1e6 * (time.perf_counter() - started)
        actuator_torque = self._actuator.update(request.torque)
        engine_torque = told
        if self._two_input:
            engine_torque = self._engine.torque(step, request.engine_torque, engine_speed)
        return {
            'joint_position': now.joint_position,
            'joint_speed': now.joint_speed,
            'joint_effort': now.joint_effort,
            'slip_speed': now.slip_speed,
            'vehicle_speed': now.vehicle_speed,
            'vehicle_accel': now.vehicle_accel,
            'torque_demand': demand,
            'engine_torque': engine_torque,
            'load_torque': self._load.torque(now.vehicle_speed, time_of_step(step)),
            'slip_reference': speeds,
            'slip_reference_rate': rates,
            'torque_request': request.torque,
            'actuator_torque': actuator_torque,
            'status': request.status,
            'engine_torque_request': request.engine_torque,
            **self._friction.reply(step, actuator_torque, now),
        }

    @property
    def over(self) -> bool:
        """Whether the engine's speed ends the run with the present state."""
        return bool(end_cause(self._scenario, self._driveline.engine_speed))

    def advance(self, reply: dict[str, Any]) -> None:
        """Integrate the driveline over the period that `reply` answered."""
        self._driveline.step(
            reply['engine_torque'],
            reply['load_torque'],
            *(reply[name] for name in self._friction.torques),
        )


def run_headless(
    settings: RunSettings, controller: str | Controller, timing: RunTiming | None = None
) -> Trajectory:
    """
    Simulate one run from t_0 to t_N and return every signal; fill `timing` if it is given.

    `controller` is a registry name or an object. Raise ParameterError for what cannot be built,
    DdctError when a controller commands a value that is not finite.
    """
    if isinstance(controller, str):
        controller = make_controller(controller, settings)
    return run_loop(ClosedLoop(settings, controller), settings.scenario.steps, timing)


def run_loop(loop: ClosedLoop, steps: int, timing: RunTiming | None = None) -> Trajectory:
    """Simulate a loop that is at t_0 up to t_`steps`; as `run_headless` otherwise."""
    timing = RunTiming() if timing is None else timing
    started = time.perf_counter()
    rows = [loop.reply(0)]
    timing.update_times_us.append(loop.update_time_us)
    for step in range(1, steps + 1):
        loop.advance(rows[-1])
        rows.append(loop.reply(step))
        timing.update_times_us.append(loop.update_time_us)
        if loop.over:
            break
    timing.steps = len(rows) - 1
    timing.wall_time_s = time.perf_counter() - started
    present = [name for name, first in rows[0].items() if first is not None]
    return Trajectory.of_columns({name: [row[name] for row in rows] for name in present})
