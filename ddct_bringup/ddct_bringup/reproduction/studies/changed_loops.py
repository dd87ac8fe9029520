# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Modified loops: a clutch without actuator, a measured state, a load step, noisy speeds.

Also the modes of the linear loop of plant, filter and feedback.
"""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.loop import ClosedLoop
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.estimate.observer import Observer
from ddct_controllers.mpc.estimators import run_start
from ddct_controllers.mpc.model.transmission_model import (
    DRIVELINE,
    ENGINE_TORQUE,
    MEASURED,
    REQUEST,
    SLIP_ACCELERATION,
    STATES,
    TRANSMISSION_STATES,
    TransmissionModel,
    transmission_model,
)
from ddct_controllers.mpc.program.horizon import CondensedProgram
from ddct_plant.base.timebase import PERIOD_S, SUBSTEPS
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.settings import KnownSettings, RunSettings

ALL_BUT_ONE = 1.0 - 1e-6
"""Magnitude above which a mode counts as an integrator."""
TWIST = TRANSMISSION_STATES['twist']
"""Index of theta_sr in the state."""


def model_without_actuator(
    driveline: DrivelineParameters, wear_gain: float = 1.0
) -> TransmissionModel:
    """
    Return the sampled driveline alone; the actuator's states have no effect.

    The clutch transmits `wear_gain` times the request.
    """
    model, plant = transmission_model(driveline), driveline_matrices(driveline)
    a, b, c, d = model.a.copy(), model.b.copy(), model.c.copy(), model.d.copy()
    a[DRIVELINE, DRIVELINE.stop :], c[:, DRIVELINE.stop :] = 0.0, 0.0
    b[:, REQUEST] += wear_gain * model.clutch
    slip, clutch = plant.output('slip_speed'), plant.torques['clutch_torque']
    d[SLIP_ACCELERATION, REQUEST] = wear_gain * slip @ plant.b[:, clutch]
    return TransmissionModel(a, b, c, d, clutch=model.clutch)


def closed_loop(
    program: CondensedProgram, observer: Observer, plant: TransmissionModel
) -> np.ndarray:
    """
    Return the matrix (2 STATES, 2 STATES) of `plant` and filter within limits.

    Without weights on the moves the inputs depend on the estimate alone.
    """
    feedback = -np.linalg.solve(program.structure.hessian, program.gradient[:, :STATES])
    inputs, measured = [REQUEST, ENGINE_TORQUE], np.eye(observer.gain.shape[1], STATES)
    correction = observer.gain @ measured
    estimate = np.hstack([correction, np.eye(STATES) - correction])
    moves, model = feedback @ estimate, observer.model
    return np.vstack(
        [
            np.hstack([plant.a, np.zeros_like(plant.a)]) + plant.b[:, inputs] @ moves,
            model.a @ estimate + model.b[:, inputs] @ moves,
        ]
    )


def growth(program: CondensedProgram, observer: Observer, plant: TransmissionModel) -> float:
    """Return the growth factor per period of the fastest-growing mode; below 1 none grows."""
    return float(np.abs(np.linalg.eigvals(closed_loop(program, observer, plant))).max())


def slow_times_s(program: CondensedProgram, observer: Observer) -> list[float]:
    """Return the three longest time constants in s with the plant that the observer assumes."""
    sizes = np.abs(np.linalg.eigvals(closed_loop(program, observer, observer.model)))
    times = [
        PERIOD_S / -math.log(size) if 0.0 < size < ALL_BUT_ONE else math.inf for size in sizes
    ]
    return sorted(times, reverse=True)[:3]


class LoopWithoutActuator(ClosedLoop):
    """Closed loop in which the request, saturated at zero, is the torque of the actuator."""

    def __init__(self, settings: RunSettings, controller: Controller) -> None:
        """Start in the run's initial state."""
        super().__init__(settings, controller)
        self.plant.sides[0].actuator = _Direct()


class _Direct:
    def update(self, request: float) -> list[float]:
        """Return the request at 0, 1, ..., 10 ms."""
        return [max(request, 0.0)] * (SUBSTEPS + 1)


class MeasuredState(Observer):
    """Observer with w_m, w_p, w_r and theta_sr measured; actuator states follow the model."""

    def __init__(self, settings: KnownSettings, model: TransmissionModel) -> None:
        super().__init__(model, np.eye(len(model.a), MEASURED + 1), run_start(settings))
        self.twist: Callable[[], float] | None = None
        """Function that returns theta_sr in rad; without it there is no estimate."""

    def correct(self, speeds: tuple[float, float, float], load_torque: float) -> np.ndarray:
        """Return x_k, (n,), for w_m, w_p, w_r in rad/s and C_load in N m."""
        assert self.twist is not None
        if not self._started:
            super().correct(speeds, load_torque)
        self._state[:MEASURED], self._state[TWIST] = speeds, self.twist()
        return self._state


class LoopWithMeasuredState(ClosedLoop):
    """Closed loop that provides theta_sr to its controller's `MeasuredState`."""

    def __init__(self, settings: RunSettings, controller: MpcController[MeasuredState]) -> None:
        """Start in the run's initial state."""
        super().__init__(settings, controller)
        controller.observer.twist = lambda: self.plant.driveline.outputs().twist


def slip_after_load_step(
    settings: RunSettings,
    controller: Controller,
    load_step_n_m: float,
    load_step_index: int,
    each_step: Callable[[], None] = lambda: None,
) -> np.ndarray:
    """
    Return w_d (steps + 1,) in rad/s of a run with a step of the load by `load_step_n_m`.

    The plant has it from step `load_step_index` on; controllers compute C_load from the vehicle
    speed, without the step. `each_step` is called after every reply of the loop.
    """
    loop = ClosedLoop(settings, controller)
    slip = np.zeros(settings.scenario.steps + 1)
    for step in range(len(slip)):
        reply = loop.reply(step)
        slip[step] = loop.plant.driveline.outputs().slip_speed
        each_step()
        if step >= load_step_index:
            reply = reply._replace(load_torque=reply.load_torque + load_step_n_m)
        loop.advance(reply)
    return slip


class NoisySpeeds(Controller):
    """Controller with Gaussian noise on w_m, w_p and w_r that repeats after every reset."""

    def __init__(self, controller: Controller, deviation_rad_s: float, seed: int) -> None:
        """Wrap `controller`; the noise has the standard deviation `deviation_rad_s`."""
        self._controller = controller
        self._deviation = deviation_rad_s
        self._seed = seed
        self.preview_steps = controller.preview_steps
        self.commands_engine = controller.commands_engine
        self.reset()

    def reset(self) -> None:
        """Reset the controller and restart the noise."""
        self._controller.reset()
        self._random = np.random.default_rng(self._seed)

    def hold(self, measurement: Measurement) -> None:
        """Pass a period with feedback held off to the controller, with noise."""
        self._controller.hold(self._noisy(measurement))

    def update(self, measurement: Measurement) -> Command:
        """Return the controller's command for noisy speeds."""
        return self._controller.update(self._noisy(measurement))

    def _noisy(self, measurement: Measurement) -> Measurement:
        engine, shaft, wheel = self._random.normal(0.0, self._deviation, 3).tolist()
        return replace(
            measurement,
            engine_speed=measurement.engine_speed + engine,
            shaft_speed=measurement.shaft_speed + shaft,
            wheel_speed=measurement.wheel_speed + wheel,
        )
