# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Finite-horizon control of the clutch torque over a time set by the pedal, after [4]."""

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
from ddct_controllers.mpc.qp.backend import DEFAULT_BACKEND, QpBackend, make_backend
from ddct_controllers.mpc.qp.problem import QpSolution
from ddct_controllers.state_of_art.parts.engagement_program import MOVES, engagement_programs
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
        self._solvers: dict[int, QpBackend] = {}

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
        known = (before, measurement.engine_torque, measurement.load_torque, slip)
        solution = self._solve(horizon, np.concatenate((state, known)), before)
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

    def _solve(self, horizon: int, known: np.ndarray, before: float) -> QpSolution:
        """Return the moves over a horizon in periods, from v and the request before in N m."""
        program = self._programs[horizon]
        if horizon not in self._solvers:
            self._solvers[horizon] = make_backend(DEFAULT_BACKEND, program.structure)
        lower = np.full(MOVES, -before)
        return self._solvers[horizon].solve(program.gradient @ known, lower, self._unlimited)

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


SPEC = ControllerSpec(NAME, PedalMpc, OPTIONS)
