# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The loop of PI in `detailed` in python-control, simulated by its `input_output_response`.

The loop has driveline, actuator with delay and cut-off, road load with drag, open loop, and
feedback from control start on. python-control simulates it sampled at 10 ms with our own exact
matrices, as blocks that `interconnect` wires. It computes the slip at 10 ms, which must equal
ours; ours computes every signal, and the clutch torque at 1 ms. C_m and the reference are inputs.
"""

import time
from typing import Any

import control
import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_controllers.registry import make_controller
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.models.actuator import ActuatorParameters, at_rest, lifted
from ddct_plant.models.linear_driveline import step_matrix
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.plant import make_load
from ddct_plant.scenario.settings import RunSettings

_NODES = [f'node{index}' for index in range(11)]
_SPEEDS = ['engine_speed', 'shaft_speed', 'wheel_speed']


class PythonControlLoop:
    """Closed loop of PI as systems of python-control."""

    def __init__(self, settings: RunSettings, run: Trajectory) -> None:
        scenario, initial = settings.scenario, initial_state(settings)
        self._driveline = step_matrix(scenario.driveline)
        model = ActuatorParameters().dynamics()
        self._actuator, self._nodes = lifted(model, 0)
        self._static = StaticTorque(scenario.driveline, scenario.equilibrium)
        self._load, self._radius = make_load(settings), scenario.vehicle.wheel_radius_m
        gains = make_controller('pi', settings.known).gains()
        self._proportional, self._integral = gains.values()
        request = max(initial.sides[0].torque_request, 0.0)
        # States: driveline with angles (7), actuator with the delayed request (5), integral.
        rest = at_rest(model, request)
        self._start = [*initial.values, *rest, request, 0.0]
        on = (np.arange(run.steps + 1) >= scenario.control_start_step).astype(float)
        self._inputs = np.array([run.engine_torque, run.slip_reference[:, 0], on])
        self._times = np.arange(run.steps + 1) * PERIOD_S
        self._run = run
        self._loop = self._blocks()

    def step_s(self) -> float:
        """Return the processor time per step in s; require the slip of our run."""
        started = time.thread_time()
        result = control.input_output_response(self._loop, self._times, self._inputs, self._start)
        taken = time.thread_time() - started
        np.testing.assert_allclose(np.ravel(result.outputs), self._run.slip_speed, atol=1e-9)
        return taken / self._run.steps

    def _blocks(self) -> Any:
        """Return the loop as five systems that `interconnect` wires by the names of signals."""
        return control.interconnect(
            [self._driveline_block(), self._actuator_block(), *self._static_blocks(), self._pi()],
            inputs=['engine_torque', 'reference', 'on'],
            outputs=['slip'],
        )

    def _driveline_block(self) -> Any:
        return control.nlsys(
            lambda t, x, u, params: self._driveline @ np.concatenate([x, u]),
            lambda t, x, u, params: np.array([x[0], x[1], x[2], x[0] - x[1]]),
            inputs=['engine_torque', 'load', *_NODES],
            outputs=[*_SPEEDS, 'slip'],
            states=7,
            dt=PERIOD_S,
            name='driveline',
        )

    def _actuator_block(self) -> Any:
        return control.nlsys(
            lambda t, x, u, params: np.append(self._actuator @ x, max(u[0], 0.0)),
            lambda t, x, u, params: self._nodes @ x,
            inputs=['request'],
            outputs=_NODES,
            states=5,
            dt=PERIOD_S,
            name='actuator',
        )

    def _static_blocks(self) -> list[Any]:
        return [
            control.nlsys(
                None,
                lambda t, x, u, params: self._load_torque(u[0]),
                inputs=['wheel_speed'],
                outputs=['load'],
                dt=PERIOD_S,
                name='load',
            ),
            control.nlsys(
                None,
                lambda t, x, u, params: self._static.torque(u[0], u[1], u[2], u[3]) + u[4],
                inputs=['engine_torque', 'load', 'engine_speed', 'shaft_speed', 'feedback'],
                outputs=['request'],
                dt=PERIOD_S,
                name='request',
            ),
        ]

    def _pi(self) -> Any:
        return control.nlsys(
            lambda t, x, u, params: u[2] * (x + PERIOD_S * rpm_from_rad_s(u[0] - u[1])),
            lambda t, x, u, params: self._feedback(x[0], u[2] * rpm_from_rad_s(u[0] - u[1])),
            inputs=['reference', 'slip', 'on'],
            outputs=['feedback'],
            states=1,
            dt=PERIOD_S,
            name='pi',
        )

    def _feedback(self, integral: float, error: float) -> float:
        return -(self._proportional * error + self._integral * integral)

    def _load_torque(self, wheel_speed: float) -> float:
        return self._load.torque(self._radius * wheel_speed)
