# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Finite-horizon control of the clutch torque over a time set by the pedal, after [4]."""

from dataclasses import dataclass

import numpy as np

from ddct_controllers.interface import (
    Command,
    Controller,
    ControllerContext,
    ControllerSpec,
    Measurement,
)
from ddct_controllers.measurement import measured_speeds
from ddct_controllers.mpc.estimators import DisturbanceObserver
from ddct_controllers.mpc.model.transmission_model import (
    ENGINE_TORQUE,
    LOAD_TORQUE,
    REQUEST,
    SLIP_SPEED,
    TransmissionModel,
)
from ddct_controllers.mpc.qp.backend import DEFAULT_BACKEND, QpBackend, make_backend
from ddct_controllers.mpc.qp.problem import QpStructure
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import Option
from ddct_plant.base.timebase import PERIOD_S

NAME = 'pedal_mpc'
OPTIONS = {
    'slowest_engagement_s': Option(
        1.2, 'engagement time with the pedal at 0', 's', at_least=0.3, at_most=5.0
    ),
    'fastest_engagement_s': Option(
        0.4,
        'engagement time with the pedal at 1, at most slowest_engagement_s',
        's',
        at_least=0.3,
        at_most=5.0,
    ),
}
"""Options of the controller; 0.3 s is seven times the lag of delay and actuator."""
SHORTEST_SHARE = 3
"""Share of the engagement time at which the shrinking horizon stays, without unit."""
MOVES = 10
"""Number of moves, spread evenly over the horizon, with a constant request between them."""
SLIP_WEIGHT = 100.0
"""Weight of the slip at the end, in N m per rad/s: 0.1 rad/s costs as much as 10 N m."""
ACCELERATION_WEIGHT = 5.0
"""Weight of dw_d/dt at the end, in N m per rad/s^2: 2 rad/s^2 cost as much as 10 N m."""


class PedalMpc(Controller):
    """
    Request that engages within the pedal's time with the least squared moves.

    The horizon t_r begins as the engagement time t_f(x_p), shrinks with the time that is left down
    to t_f/3, and then recedes. At its end slip and its rate shall be zero. C_m is a known input
    and not commanded; it, C_load and two estimated disturbances are taken as constant. Until
    control starts the desired slip is the reference's, over the shortest horizon; from then on the
    reference has no effect.
    """

    def __init__(self, context: ControllerContext) -> None:
        """Condense the programs; raise ParameterError for a bad option."""
        settings = context.settings
        model, self._observer = DisturbanceObserver().parts(settings)
        self._control_start = None if settings.shift else settings.scenario.control_start_step
        self._longest = round(engagement_time_s(context) / PERIOD_S)
        self._shortest = self._longest // SHORTEST_SHARE
        self._programs = engagement_programs(model, self._shortest, self._longest)
        self._unlimited = np.full(MOVES, np.inf)
        self.reset()

    def reset(self) -> None:
        """Clear the estimate, the last request and every warm start."""
        self._observer.reset()
        self._request: float | None = None
        self._start_step = self._control_start
        self._fallbacks = 0
        for program in self._programs.values():
            program.solver.reset()

    def hold(self, measurement: Measurement) -> None:
        """Let the observer follow the plant under the open-loop torque alone."""
        self._observer.correct(measured_speeds(measurement), measurement.load_torque)
        self._advance(measurement, max(measurement.open_loop_torque, 0.0))

    def update(self, measurement: Measurement) -> Command:
        """Return the first move of the optimal request."""
        state = self._observer.correct(measured_speeds(measurement), measurement.load_torque)
        horizon, slip = self._horizon_and_slip(measurement)
        before = self._request
        if before is None:
            before = max(measurement.open_loop_torque, 0.0)
        program = self._programs[horizon]
        known = (before, measurement.engine_torque, measurement.load_torque, slip)
        solution = program.solver.solve(
            program.gradient @ np.concatenate((state, known)),
            np.full(MOVES, -before),
            self._unlimited,
        )
        if solution.status == 'solved':
            request = max(before + float(solution.z[0]), 0.0)
        else:
            self._fallbacks += 1
            request = before
        self._advance(measurement, request)
        return Command(
            request - measurement.open_loop_torque,
            (
                ('horizon_s', repr(horizon * PERIOD_S)),
                ('qp_status', solution.status),
                ('qp_iterations', str(solution.iterations)),
                ('fallbacks', str(self._fallbacks)),
            ),
        )

    def _horizon_and_slip(self, measurement: Measurement) -> tuple[int, float]:
        """Return t_r in periods and the desired slip at its end in rad/s."""
        if self._start_step is None:  # a shift, in which feedback starts with the handover's end
            self._start_step = measurement.step
        since_start = measurement.step - self._start_step
        if since_start < 0:
            return self._shortest, measurement.slip_reference[0]
        return max(self._longest - since_start, self._shortest), 0.0

    def _advance(self, measurement: Measurement, request: float) -> None:
        self._request = request
        self._observer.predict((request, measurement.engine_torque, measurement.load_torque))


def engagement_time_s(context: ControllerContext) -> float:
    """
    Return t_f(x_p) = slowest + x_p (fastest - slowest) in s, x_p the scenario's pedal position.

    In the thesis t_r is a function of the engagement time and this of the pedal, both without a
    formula: this line, and t_r above, are assumptions.
    """
    slowest, fastest = SPEC.values(context.gains).values()
    if fastest > slowest:
        raise ParameterError(
            f'controllers.{NAME}.fastest_engagement_s is {fastest:g} s: it must be at most '
            f'slowest_engagement_s, {slowest:g} s'
        )
    return slowest + context.settings.scenario.pedal_position * (fastest - slowest)


@dataclass(frozen=True, eq=False)
class EngagementProgram:
    """
    Minimise the squared moves of the request plus the squared weighted deviations at the end.

    The deviations are those of the slip from the desired one and of its rate over the last period
    from zero. With v = (state, request before, C_m, C_load, desired slip), f = gradient @ v; the
    constrained rows are the request's levels less the request before.
    """

    gradient: np.ndarray
    """Map from v to the linear cost f, (MOVES, states + 4)."""
    solver: QpBackend


def engagement_programs(
    model: TransmissionModel, shortest: int, longest: int
) -> dict[int, EngagementProgram]:
    """Return the programs for horizons of `shortest` (MOVES or more) to `longest` periods."""
    c = model.c[SLIP_SPEED]
    states, held = np.eye(len(model.a)), np.zeros((len(model.a), 3))
    free, steps = [c @ states], [c @ held]
    for _ in range(longest):
        states, held = model.a @ states, model.a @ held + model.b
        free.append(c @ states)
        steps.append(c @ held)
    return {
        horizon: _program(np.array(free[: horizon + 1]), np.array(steps[: horizon + 1]))
        for horizon in range(shortest, longest + 1)
    }


def _program(free: np.ndarray, steps: np.ndarray) -> EngagementProgram:
    """
    Condense one horizon of p periods.

    `free` (p + 1, n) is the slip's response to the state at periods 0..p, `steps` (p + 1, 3) that
    to unit steps of the inputs from period 0 on.
    """
    horizon = len(steps) - 1
    starts = [move * horizon // MOVES for move in range(MOVES)]
    ends = np.array([[0.0, SLIP_WEIGHT], [-1.0, 1.0]])
    ends[1] *= ACCELERATION_WEIGHT / PERIOD_S
    # At the last two periods, to a step that begins at each start.
    delayed = [steps[horizon - 1 - start : horizon + 1 - start, REQUEST] for start in starts]
    response = ends @ np.transpose(delayed)
    inputs = steps[-2:, [REQUEST, ENGINE_TORQUE, LOAD_TORQUE]]
    known = np.hstack([ends @ free[-2:], ends @ inputs, [[-SLIP_WEIGHT], [0.0]]])
    levels = np.tril(np.ones((MOVES, MOVES)))
    structure = QpStructure(np.eye(MOVES) + response.T @ response, levels)
    solver = make_backend(DEFAULT_BACKEND, structure)
    return EngagementProgram(response.T @ known, solver)


SPEC = ControllerSpec(NAME, PedalMpc, OPTIONS)
