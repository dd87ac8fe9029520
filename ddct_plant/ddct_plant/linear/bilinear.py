# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Bilinear transform between z-plane and w-plane, in which sampled systems become continuous."""

import math

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace


def to_w_plane(system: StateSpace) -> StateSpace:
    """
    Return a sampled system with z = (1 + w T/2) / (1 - w T/2): continuous, with the same norm.

    The unit circle becomes the imaginary axis, tan(omega T/2) 2/T for omega. A strictly proper
    system gets feedthrough, its value at half the sampling rate. Raise ParameterError for a
    continuous system or a pole at z = -1.
    """
    if system.period_s is None:
        raise ParameterError('w-plane: the system is continuous: discretise it first')
    root = math.sqrt(system.period_s)
    try:
        inverse = np.linalg.inv(np.eye(len(system.a)) + system.a)
    except np.linalg.LinAlgError as error:
        raise ParameterError('w-plane: the system has a pole at z = -1') from error
    return StateSpace(
        2.0 / system.period_s * inverse @ (system.a - np.eye(len(system.a))),
        2.0 / root * inverse @ system.b,
        2.0 / root * system.c @ inverse,
        system.d - system.c @ inverse @ system.b,
    )


def from_w_plane(system: StateSpace, period_s: float = PERIOD_S) -> StateSpace:
    """Return the sampled system with w = 2/T (z - 1) / (z + 1): the inverse of `to_w_plane`."""
    root = math.sqrt(period_s)
    half = system.a * period_s / 2.0
    inverse = np.linalg.inv(np.eye(len(half)) - half)
    return StateSpace(
        inverse @ (np.eye(len(half)) + half),
        root * inverse @ system.b,
        root * system.c @ inverse,
        system.d + period_s / 2.0 * system.c @ inverse @ system.b,
        period_s,
    )
