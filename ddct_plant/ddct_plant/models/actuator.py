# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Actuator: saturation, delay and the second-order pair G_a(s) (Section 1.4.2)."""

from collections import deque
from dataclasses import dataclass

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import OptionGroup, option
from ddct_plant.base.timebase import SUBSTEP_S, SUBSTEPS
from ddct_plant.linear.cascade import Factor
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.linear.sampling import lift_zoh_dense
from ddct_plant.models.printed import ACTUATOR


@dataclass(frozen=True)
class ActuatorParameters(OptionGroup, prefix='actuator.'):
    """
    The actuator of a car: its delay, and its bandwidth over that of the one that is printed.

    The controllers of the thesis assume the printed one, those with a model of their own the one
    of the known settings.
    """

    delay_s: float = option(
        0.01,
        'delay of the request in front of G_a, a multiple of 1 ms; the thesis assumes 10 ms',
        's',
        source='Section 1.4.2',
        at_least=0.0,
        at_most=1.0,
    )
    bandwidth_factor: float = option(
        1.0,
        'bandwidth of G_a(s) over that of the print: G_a(s / factor); the thesis assumes 1',
        source='Section 1.4.2',
        at_least=0.05,
        at_most=10.0,
    )

    def __post_init__(self) -> None:
        """Check delay and factor; raise ParameterError that names a bad one."""
        super().__post_init__()
        if abs(self.delay_s / SUBSTEP_S - self.delay_substeps) > 1e-6:
            raise ParameterError(
                f'actuator.delay_s is {self.delay_s:g} s: give a multiple of {SUBSTEP_S} s',
                key='actuator.delay_s',
            )

    @property
    def delay_substeps(self) -> int:
        """Delay of the request in steps of 1 ms."""
        return round(self.delay_s / SUBSTEP_S)

    @property
    def lag_s(self) -> float:
        """Time in s from a request to its torque: the delay and -d ln G_a/ds at s = 0."""
        factor = self.bandwidth_factor
        poles = sum(_time_constant_s(each) for each in ACTUATOR.denominator)
        zeros = sum(_time_constant_s(each) for each in ACTUATOR.numerator)
        return self.delay_s + poles / factor - zeros / factor

    def transfer_function(self) -> FactoredTransferFunction:
        """Return G_a(s / factor) as the thesis prints it."""
        return ACTUATOR.faster(self.bandwidth_factor)

    def dynamics(self) -> StateSpace:
        """Return G_a(s / factor), one input, one output."""
        model, factor = ACTUATOR.to_state_space(), self.bandwidth_factor
        return StateSpace(factor * model.a, factor * model.b, model.c, model.d)


PRINTED_ACTUATOR = ActuatorParameters()
"""Actuator with 10 ms delay and G_a(s), for which the designs of the thesis are made."""


def _time_constant_s(factor: Factor) -> float:
    """Return the derivative of ln(s + a), or of ln(s^2 + b s + c), at s = 0."""
    return factor[0] / factor[1] if isinstance(factor, tuple) else 1.0 / factor


class Actuator:
    """
    The actuator: delivered torque for the requested torque, exact between samples.

    The request is cut off below zero, delayed and filtered by G_a(s). G_a is strictly proper, so
    the torque is continuous; its 11 nodes over a period resolve modes up to 206 rad/s, which the
    10 ms grid would not.
    """

    def __init__(
        self, initial_request: float = 0.0, parameters: ActuatorParameters | None = None
    ) -> None:
        """Start in the steady state for `initial_request` in N m, delay line included."""
        parameters = parameters or ActuatorParameters()
        model = parameters.dynamics()
        periods, late = divmod(parameters.delay_substeps, SUBSTEPS)
        self._inputs = 2 if late else 1
        """Number of requests in effect within one period: two if the delay is no multiple of
        10 ms; with a delay of 13 ms the request changes after 3 ms."""
        self._state_update, self._nodes = lifted(model, late)
        delayed = max(initial_request, 0.0)
        self._state_and_delayed = np.array([*at_rest(model, delayed), *[delayed] * self._inputs])
        self._waiting = deque([delayed] * (periods + self._inputs - 1))

    def update(self, request: float) -> list[float]:
        """Return the torque in N m at 0, 1, ..., 10 ms, (11,), and accept a request in N m."""
        values, waiting = self._state_and_delayed, self._waiting
        waiting.append(max(request, 0.0))
        values[-1] = waiting[self._inputs - 1]
        values[-self._inputs] = waiting.popleft()
        nodes = (self._nodes @ values).tolist()
        values[: -self._inputs] = self._state_update @ values
        return nodes

    def mean_torque(self, request: float) -> float:
        """Return the mean torque of a period in N m, and accept a request, as `update` does."""
        return float(sum(self.update(request)[:-1])) / SUBSTEPS


def at_rest(model: StateSpace, request: float) -> np.ndarray:
    """Return the steady state (n,) of G_a for a request in N m."""
    return np.linalg.solve(model.a, -model.b[:, 0] * request)


def lifted(model: StateSpace, late: int) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the matrices from the state and the requests of a period to next state and torques.

    `late` is the time in ms, 0 to 9, after which the later of two requests takes effect; 0: there
    is one request. The first matrix is (n, n + inputs), the second (11, n + inputs); their columns
    are in the order state, earlier, later request.
    """
    transition, held, outputs, feedthrough = _over(model, SUBSTEPS - late)
    if not late:
        return np.hstack([transition, held]), np.hstack([outputs, feedthrough])
    first_transition, first_held, first_outputs, first_feedthrough = _over(model, late)
    begun = np.hstack([first_transition, first_held, np.zeros_like(first_held)])
    state_update = transition @ begun
    state_update[:, -1:] += held
    before = np.hstack([first_outputs, first_feedthrough, np.zeros_like(first_feedthrough)])
    after = outputs @ begun
    after[:, -1:] += feedthrough
    return state_update, np.vstack([before[:-1], after])


def _over(model: StateSpace, substeps: int) -> tuple[np.ndarray, ...]:
    return lift_zoh_dense(model, substeps * SUBSTEP_S, substeps)
