# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Exact discretisation of linear systems over a sampling period."""

import numpy as np

from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.linear.exponentials import exponentials
from ddct_plant.linear.lti import StateSpace


def discretise_zoh(system: StateSpace, period_s: float) -> StateSpace:
    """
    Return the exact sampled system for inputs held over each period of `period_s` seconds.

    exp([[a, b], [0, 0]] T) = [[a_d, b_d], [0, 1]].
    """
    if system.period_s is not None:
        raise ParameterError(f'state space is already sampled at {system.period_s:g} s')
    require_number('period_s', period_s, above=0.0)
    a_d, b_d = hold_inputs(system.a, system.b, period_s)
    return StateSpace(a_d, b_d, system.c, system.d, period_s)


def hold_inputs(a: np.ndarray, b: np.ndarray, period_s: float) -> tuple[np.ndarray, np.ndarray]:
    """Return a_d and b_d of `discretise_zoh`; a (..., n, n) and b (..., n, m) may be stacks."""
    states, inputs = b.shape[-2:]
    block = np.zeros((*a.shape[:-2], states + inputs, states + inputs))
    block[..., :states, :states], block[..., :states, states:] = a, b
    transition = _exponential(block * period_s)[..., :states, :]
    return transition[..., :states], transition[..., states:]


def lift_piecewise_linear(
    a: np.ndarray, b: np.ndarray, period_s: float, intervals: int
) -> tuple[np.ndarray, np.ndarray]:
    """
    Return a_d (n, n) and gamma (n, intervals + 1), so that x_(k+1) = a_d x_k + gamma @ nodes.

    `b` is the column of one input, (n,) or (n, 1); `nodes` are its values at the ends of
    `intervals` equal parts of the period, between which it is linear. Exact: over one part of
    length h, u(t) = u_0 + (u_1 - u_0) t / h makes (x, u, u_1 - u_0) an autonomous linear system.
    Of stacks, a (..., n, n) and b (..., n, 1), both results are stacks.
    """
    require_number('intervals', intervals, at_least=1)
    require_number('period_s', period_s, above=0.0)
    stack, states = a.shape[:-2], a.shape[-1]
    part_s = period_s / intervals
    block = np.zeros((*stack, states + 2, states + 2))
    block[..., :states, :states] = a
    block[..., :states, states] = np.reshape(b, (*stack, states))
    block[..., states, states + 1] = 1.0 / part_s
    transition = _exponential(block * part_s)[..., :states, :]
    step, level, change = transition[..., :states], transition[..., -2], transition[..., -1]
    a_d, gamma = np.eye(states), np.zeros((*stack, states, intervals + 1))
    for part in reversed(range(intervals)):
        gamma[..., part : part + 2] += a_d @ np.stack([level - change, change], axis=-1)
        a_d = a_d @ step
    return a_d, gamma


def lift_zoh_dense(
    system: StateSpace, period_s: float, intervals: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """
    Return a_d, b_d and the outputs within a period for an input u held over it.

    x_(k+1) = a_d x_k + b_d u; the outputs at i period_s / intervals, i = 0..intervals, stacked
    node after node, are outputs @ x_k + feedthrough @ u with outputs (nodes p, n) and feedthrough
    (nodes p, m), nodes = intervals + 1. Node 0 has the input of this period already.
    """
    require_number('intervals', intervals, at_least=1)
    part = discretise_zoh(system, period_s / intervals)
    a_d, b_d = np.eye(len(part.a)), np.zeros(part.b.shape)
    outputs, feedthrough = [system.c], [system.d]
    for _ in range(intervals):
        b_d = b_d + a_d @ part.b
        a_d = a_d @ part.a
        outputs.append(system.c @ a_d)
        feedthrough.append(system.c @ b_d + system.d)
    return a_d, b_d, np.vstack(outputs), np.vstack(feedthrough)


def _exponential(matrix: np.ndarray) -> np.ndarray:
    if matrix.ndim > 2:
        return exponentials(matrix)
    # Only here: most of the graph's nodes do without scipy, whose import would double their start.
    from scipy.linalg import expm

    return expm(matrix)
