# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A sampled system with a delayed input is the continuous one whose input is delayed."""

import numpy as np
import pytest

from ddct_plant.base.timebase import PERIOD_S, SUBSTEP_S, SUBSTEPS
from ddct_plant.linear.delayed_input import acting_inputs, with_waiting_inputs
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import discretise_zoh

SYSTEM = StateSpace(
    np.array([[-3.0, 40.0], [-40.0, -5.0]]),
    np.array([[1.0, 7.0], [2.0, -30.0]]),
    np.eye(2),
    np.zeros((2, 2)),
)
DELAYED = 1
"""Column of the input that is delayed; the other one is 0."""


def delayed_by_steps_of_1_ms(inputs: np.ndarray, delay_ms: int) -> np.ndarray:
    """Return the states (N, 2) at the start of each period for inputs (N,)."""
    part = discretise_zoh(SYSTEM, SUBSTEP_S)
    held = [*[0.0] * delay_ms, *np.repeat(inputs, SUBSTEPS)]
    state, states = np.zeros(2), []
    for step in range(len(inputs) * SUBSTEPS):
        if step % SUBSTEPS == 0:
            states.append(state)
        state = part.a @ state + part.b[:, DELAYED] * held[step]
    return np.array(states)


@pytest.mark.parametrize('delay_ms', [0, 3, 10, 13, 20, 29])
@pytest.mark.parametrize('at_least', [0, 1, 4])
def test_the_states_are_those_of_the_continuous_system(delay_ms: int, at_least: int) -> None:
    inputs = np.random.default_rng(3).normal(size=20)
    periods, late = divmod(delay_ms, SUBSTEPS)
    acting = acting_inputs(SYSTEM, late, DELAYED)
    a, b = with_waiting_inputs(
        discretise_zoh(SYSTEM, PERIOD_S).a, acting, periods, at_least=at_least
    )
    waiting = max(periods + bool(late), at_least)
    assert len(a) == 2 + waiting
    state, states = np.zeros(len(a)), []
    for value in inputs:
        states.append(state)
        state = a @ state + b[:, 0] * value
    expected = delayed_by_steps_of_1_ms(inputs, delay_ms)
    np.testing.assert_allclose(np.array(states)[:, :2], expected, atol=1e-12)
    if waiting:
        assert state[2:].tolist() == inputs[-waiting:].tolist()
