# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The model predictive controller: one step, from the measurement to the command."""

from dataclasses import replace
from typing import Generic, TypeVar

import numpy as np

from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.measurement import measured_speeds
from ddct_controllers.mpc.estimate.observer import Observer
from ddct_controllers.mpc.estimate.wear_observer import WearObserver
from ddct_controllers.mpc.inputs import CLUTCH, ENGINE, ClutchInput, CommandedEngine, KnownEngine
from ddct_controllers.mpc.model.transmission_model import (
    SLIP_ACCELERATION,
    SLIP_SPEED,
    TransmissionModel,
    with_engine,
)
from ddct_controllers.mpc.program.horizon import condense
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_controllers.mpc.qp.backend import make_backend
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine import EngineAuthority

Estimator = TypeVar('Estimator', bound=Observer | WearObserver)


class MpcController(Controller, Generic[Estimator]):
    """
    Compute the moves of the inputs that minimise the cost of `MpcSettings`.

    It is composed of a model, an observer, the program that both make with the settings, and the
    inputs: the clutch torque request, and C_m if an engine's authority is given. C_m or the
    driver's demand for it, C_load as far as it is an input of the model, and the architecture's
    open-loop torque are measured inputs, taken as constant over the horizon. The limits are those
    of the whole clutch torque request, open loop included; moves are those of the controller's own
    part.

    The program is that of a new clutch. What drives the slip is divided by the wear gain K_usura
    that the observer estimates, limits and moves remain those of the request; so the cost is that
    of the transmitted torque's moves, and the closed loop is the same at every wear.
    """

    def __init__(
        self,
        model: TransmissionModel,
        observer: Estimator,
        settings: MpcSettings,
        authority: EngineAuthority | None = None,
    ) -> None:
        """
        Build the program; raise ParameterError when the settings do not make one.

        `model` has no engine as a state, `authority` limits the second input if there is one.
        """
        self.commands_engine = authority is not None
        self._inputs = 1 + self.commands_engine
        if len(settings.inputs) != self._inputs:
            raise ParameterError(
                f'MPC: {len(settings.inputs)} inputs given: with'
                f'{"" if authority else "out"} an engine authority it decides {self._inputs}',
                key='inputs',
            )
        if authority is not None:
            model = with_engine(model, authority.lag_share)
            settings = CommandedEngine.limited_by_rows(settings)
        self.observer = observer
        """Observer of the model's state, and of the wear gain."""
        self.settings = settings
        """Cost, horizon, limits and solver from which the program was built."""
        self.authority = authority
        """Limits and lag of the engine; None if the engine is not commanded."""
        self.program = condense(model, settings)
        """Quadratic program of every period, in the moves of the inputs."""
        self.clutch = ClutchInput(self.program, settings.inputs[CLUTCH])
        self.engine: KnownEngine | CommandedEngine = KnownEngine()
        """Second input: an engine that the controller commands, or the driver's alone."""
        if authority is not None:
            rows = self.program.level_rows[ENGINE]
            self.engine = CommandedEngine(authority, rows, settings.control_steps)
        structure = self.program.structure
        self.solver = make_backend(settings.backend, structure, settings.iteration_limit)
        """Solver of that program, which starts each time from its last solution."""
        self.preview_steps = settings.prediction_steps if settings.preview else 0
        self.reset()

    def reset(self) -> None:
        """Clear plan and counts; the observer starts anew with the next measurement."""
        for part in (self.solver, self.observer, self.clutch, self.engine):
            part.reset()
        self._plan = np.zeros(self.program.structure.hessian.shape[0])
        self.fallbacks = 0

    def hold(self, measurement: Measurement) -> None:
        """Let the observer follow the plant under the open-loop torque alone."""
        self.observer.correct(measured_speeds(measurement), measurement.load_torque)
        request = self.clutch.hold(measurement)
        delivered = self.engine.hold(measurement)
        self.observer.predict((request, delivered, measurement.load_torque))

    def update(self, measurement: Measurement) -> Command:
        """
        Return the first of the moves that minimise the cost over the horizon.

        When the solver gives no solution, the rest of the last plan is followed within the limits;
        each such step is counted and shown as `fallbacks` in `controller/status`.
        """
        observer, clutch, engine, program = self.observer, self.clutch, self.engine, self.program
        # Estimate the state, and the wear.
        state = observer.correct(measured_speeds(measurement), measurement.load_torque)
        gain, estimated = observer.wear_gain, observer.status
        # What is known of the horizon: torques, and the reference with or without preview.
        ahead = divided(measurement, gain)
        level, jump = clutch.before(measurement)
        known = np.concatenate((state, engine.known(level, ahead, gain)))
        # Without a move of its own the controller leaves C_fOL, and the engine on the demand.
        others = (0.0,) * (self._inputs - 1)
        targets = (measurement.open_loop_torque, *others)
        # The program of this period.
        speeds, rates = np.array([ahead.slip_reference, ahead.slip_reference_rate])
        reference_values = references(self.settings, speeds, rates).ravel()
        f = program.gradient @ np.concatenate((known, targets, reference_values))
        shift = program.shift @ np.concatenate((known, (jump, *others)))
        lower, upper = engine.bounds(clutch.bounds(level - jump, gain), measurement, gain)
        solution = self.solver.solve(f, lower - shift, upper - shift)
        # The first moves of the solution, or the next ones of the last plan within the limits.
        solved = solution.status == 'solved'
        if solved:
            self._plan = solution.z
        else:
            self.fallbacks += 1
            self._plan = np.concatenate([self._plan[self._inputs :], np.zeros(self._inputs)])
        move, *engine_move = self._plan[: self._inputs].tolist()
        if not solved:
            move = clutch.nearest(level + move, level - jump) - level
        # The command, whose effect the observer predicts.
        own_torque = clutch.keep(level + move, measurement)
        engine_request, delivered, engine_status = engine.command(
            engine_move, measurement, gain, solved=solved
        )
        observer.predict((max(level + move, 0.0), delivered, measurement.load_torque))
        status = (
            ('qp_status', solution.status),
            ('qp_iterations', str(solution.iterations)),
            ('fallbacks', str(self.fallbacks)),
            *estimated,
            *engine_status,
        )
        return Command(own_torque, status, engine_request)


def divided(measurement: Measurement, gain: float) -> Measurement:
    """
    Return a measurement with C_m, C_load and the references divided by K_usura = `gain`.

    Slip is linear in K_usura times the request. With these and the driveline's states divided by
    K_usura, the request obeys the equations of a new clutch.
    """
    if gain == 1.0:
        return measurement
    return replace(
        measurement,
        engine_torque=measurement.engine_torque / gain,
        load_torque=measurement.load_torque / gain,
        slip_reference=[speed / gain for speed in measurement.slip_reference],
        slip_reference_rate=[rate / gain for rate in measurement.slip_reference_rate],
    )


def references(settings: MpcSettings, speeds: np.ndarray, rates: np.ndarray) -> np.ndarray:
    """
    Return the references of the weighted outputs at the periods 1..p, (..., p, outputs).

    `speeds` in rad/s and `rates` in rad/s^2 are those of the slip, (..., P + 1), with any axes in
    front. They are the coming ones with preview, else the present ones, or that of the slip along
    its tangent; those of other outputs than the slip and its rate are zero.
    """
    values = np.zeros((*speeds.shape[:-1], settings.prediction_steps, len(settings.outputs)))
    coming = slice(1, None) if settings.preview else slice(0, 1)
    for column, terms in enumerate(settings.outputs):
        if terms.output == SLIP_SPEED:
            values[..., column] = speeds[..., coming]
            if settings.along_tangent and not settings.preview:
                steps = np.arange(1, settings.prediction_steps + 1)
                values[..., column] += PERIOD_S * rates[..., :1] * steps
        elif terms.output == SLIP_ACCELERATION:
            values[..., column] = rates[..., coming]
    return values
