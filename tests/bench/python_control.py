# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Time of a headless run, and of python-control's `input_output_response` on the same loop.

The loop is that of PI in `detailed`: driveline, actuator with delay and cut-off, road load with
drag, open loop, feedback from control start on. python-control simulates it twice, both
times sampled at 10 ms with our own exact matrices: as blocks that `interconnect` wires, which is
its usual way to build a loop, and as one block written by hand, the fastest form. Both compute the
slip at 10 ms, which must equal ours; ours computes every signal, and the clutch torque at 1 ms.
C_m and the reference are inputs of both.
"""

import statistics
import time
from collections.abc import Mapping
from typing import Any

import control
import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.headless import ClosedLoop, run_loop
from ddct_controllers.registry import make_controller
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.models.actuator import ActuatorParameters, at_rest, lifted
from ddct_plant.models.driveline import step_matrix
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.plant import initial_state, make_load
from ddct_plant.scenario.settings import RunSettings

GOAL = 3.0
"""Goal of the ratio of the time of python-control's blocks to ours, at least."""
_ROUNDS = 5
_NODES = [f'node{index}' for index in range(11)]
_SPEEDS = ['engine_speed', 'shaft_speed', 'wheel_speed']


def measure() -> dict[str, float]:
    """Return the median times in ms of ours, the blocks and the one block, measured in turn."""
    settings = RunSettings(load_scenario('thesis'))
    ours, run = _ours(settings)
    loop = _Loop(settings, run)
    taken: dict[str, list[float]] = {'ours_ms': [], 'blocks_ms': [], 'one_block_ms': []}
    for _ in range(_ROUNDS):
        taken['ours_ms'].append(_ours(settings)[0])
        taken['blocks_ms'].append(loop.response(loop.blocks(), run))
        taken['one_block_ms'].append(loop.response(loop.one_block(), run))
    return {name: statistics.median(times) for name, times in taken.items()}


def print_table(results: Mapping[str, float]) -> None:
    """Print the results of `measure`."""
    ours = results['ours_ms']
    ratio = results['blocks_ms'] / ours
    print(
        f'headless run of 3 s: {ours:.1f} ms; python-control of blocks '
        f'{results["blocks_ms"]:.1f} ms, {ratio:.1f} times as long (goal {GOAL:g}: '
        f'{"met" if ratio >= GOAL else "MISSED"}); as one block by hand '
        f'{results["one_block_ms"]:.1f} ms, {results["one_block_ms"] / ours:.1f} times'
    )


def _ours(settings: RunSettings) -> tuple[float, Trajectory]:
    loop = ClosedLoop(settings, make_controller('pi', settings))
    started = time.thread_time()
    run = run_loop(loop, settings.scenario.steps)
    return 1e3 * (time.thread_time() - started), run


class _Loop:
    """Closed loop of PI as systems of python-control."""

    def __init__(self, settings: RunSettings, run: Trajectory) -> None:
        scenario, initial = settings.scenario, initial_state(settings)
        self._driveline = step_matrix(scenario.driveline)
        model = ActuatorParameters().dynamics()
        self._actuator, self._nodes = lifted(model, 0)
        self._static = StaticTorque(scenario.driveline, scenario.equilibrium)
        self._load, self._radius = make_load(settings), scenario.vehicle.wheel_radius_m
        gains = make_controller('pi', settings).gains()
        self._proportional, self._integral = gains.values()
        request = max(initial.torque_request, 0.0)
        # States: driveline with angles (7), actuator with the delayed request (5), integral.
        speeds = initial.engine_speed, initial.shaft_speed, initial.wheel_speed
        rest = at_rest(model, request)
        self._start = [*speeds, initial.twist, 0.0, 0.0, 0.0, *rest, request, 0.0]
        on = (np.arange(run.steps + 1) >= scenario.control_start_step).astype(float)
        self._inputs = np.array([run.engine_torque, run.slip_reference[:, 0], on])
        self._times = np.arange(run.steps + 1) * PERIOD_S

    def response(self, loop: Any, run: Trajectory) -> float:
        """Return the time of the simulation in ms; require the slip of our run."""
        started = time.thread_time()
        result = control.input_output_response(loop, self._times, self._inputs, self._start)
        taken = time.thread_time() - started
        np.testing.assert_allclose(np.ravel(result.outputs), run.slip_speed, atol=1e-9)
        return 1e3 * taken

    def one_block(self) -> Any:
        """Return the loop as one system with 13 states."""

        def request_of(x: np.ndarray, u: np.ndarray) -> tuple[float, float, float]:
            load, error = self._load_torque(x[2]), u[2] * rpm_from_rad_s(u[1] - x[0] + x[1])
            open_loop = self._static.torque(u[0], load, x[0], x[1])
            return load, error, open_loop + self._feedback(x[12], error)

        def update(t: float, x: np.ndarray, u: np.ndarray, params: Any) -> np.ndarray:
            load, error, request = request_of(x, u)
            following = np.empty(13)
            nodes = self._nodes @ x[7:12]
            following[:7] = self._driveline @ np.concatenate([x[:7], [u[0], load], nodes])
            following[7:11] = self._actuator @ x[7:12]
            following[11] = max(request, 0.0)
            following[12] = u[2] * (x[12] + PERIOD_S * error)
            return following

        return control.nlsys(
            update,
            lambda t, x, u, params: x[0] - x[1],
            inputs=3,
            outputs=1,
            states=13,
            dt=PERIOD_S,
        )

    def blocks(self) -> Any:
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


if __name__ == '__main__':
    print_table(measure())
