# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The three simplified plants of Section 1.5.1, to compare with the detailed one (Figure 1.23).

Each is a function from the driveline and a slip phase to w_d in rad/s at t_0..t_N, (N + 1,).
This module has the two that are sums of three one-input systems, stepped exactly; `elementary` has
the one that integrates a block diagram.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S, SUBSTEPS
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.linear.sampling import discretise_zoh, lift_piecewise_linear
from ddct_plant.models.driveline_model import (
    STATES,
    clutch_to_slip,
    driveline_matrices,
    engine_to_slip,
    load_to_slip,
)
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.printed import CLUTCH_TO_SLIP, ENGINE_TO_SLIP, LOAD_TO_SLIP


@dataclass(frozen=True, eq=False)
class SlipPhase:
    """Torques in N m over N periods of 10 ms, and the state of the driveline before them."""

    engine_torque: np.ndarray
    """C_m in N m, (N,), held over each period."""
    clutch_points: np.ndarray
    """C_f in N m, (N, 11), linear between the points."""
    load_torque: np.ndarray
    """C_load in N m, (N,), held over each period."""
    initial_state: np.ndarray
    """Initial values of STATES of the driveline, (n,)."""

    def __post_init__(self) -> None:
        """Check the shapes; raise ParameterError that names a bad one."""
        periods = np.size(self.engine_torque)
        shapes = {
            'engine_torque': (periods,),
            'clutch_points': (periods, SUBSTEPS + 1),
            'load_torque': (periods,),
            'initial_state': (len(STATES),),
        }
        for name, shape in shapes.items():
            given = np.shape(getattr(self, name))
            if given != shape:
                raise ParameterError(f'{name} has shape {given}, it must be {shape}', key=name)


SimplifiedPlant = Callable[[DrivelineParameters, SlipPhase], np.ndarray]
"""Function from the driveline and a slip phase to w_d in rad/s at t_0..t_N, (N + 1,)."""


def state_space_slip(parameters: DrivelineParameters, phase: SlipPhase) -> np.ndarray:
    """
    Add up three state-space blocks (A, B(:, i), C, D(:, i)), one per torque (Figure 1.21).

    Each has all states of its own. The initial condition goes into the block of C_f alone: in
    more than one of them it would count twice.
    """
    model = driveline_matrices(parameters)
    blocks = [model.path(torque, 'slip_speed') for torque in model.torques]
    return _added_up(blocks, phase, phase.initial_state)


def lti_slip(parameters: DrivelineParameters, phase: SlipPhase) -> np.ndarray:
    """Add up P_1, P_2, P_3 of the driveline, not rounded, and its free response (Figure 1.22)."""
    functions = [engine_to_slip(parameters), clutch_to_slip(parameters), load_to_slip(parameters)]
    return _of_transfer_functions(functions, parameters, phase)


def printed_lti_slip(parameters: DrivelineParameters, phase: SlipPhase) -> np.ndarray:
    """
    Add up the thesis's rounded P_1, P_2, P_3 (Section 1.6.2) and the driveline's free response.

    C_m P_1 and C_f P_2 nearly cancel, so rounding costs more than its digits: 0.23 % of the slip
    peak after the 1.1 s of Figure 1.23, growing with time.
    """
    printed = ENGINE_TO_SLIP, CLUTCH_TO_SLIP, LOAD_TO_SLIP
    return _of_transfer_functions([each.factored() for each in printed], parameters, phase)


def _of_transfer_functions(
    functions: list[FactoredTransferFunction], parameters: DrivelineParameters, phase: SlipPhase
) -> np.ndarray:
    """
    Add up the responses of three transfer functions to the torques, and C e^(A t) x_0.

    Transfer functions start from zero, without an initial condition, so the free response of the
    driveline is a term of its own.
    """
    blocks = [function.to_state_space() for function in functions]
    model = driveline_matrices(parameters)
    path = model.path('load_torque', 'slip_speed')
    free = StateSpace(path.a, np.zeros_like(path.b), path.c, path.d)
    forced = _added_up(blocks, phase, np.zeros(len(blocks[1].a)))
    return forced + _held_response(free, np.zeros(len(phase.engine_torque)), phase.initial_state)


def _added_up(blocks: list[StateSpace], phase: SlipPhase, clutch_start: np.ndarray) -> np.ndarray:
    """Return the sum of the outputs for C_m, C_f and C_load; `clutch_start` is C_f's state."""
    engine, clutch, load = blocks
    transition, nodes = lift_piecewise_linear(clutch.a, clutch.b, PERIOD_S, SUBSTEPS)
    pushes = phase.clutch_points @ nodes.T
    return (
        _held_response(engine, phase.engine_torque, np.zeros(len(engine.a)))
        + _response(transition, clutch.c[0], pushes, clutch_start)
        + _held_response(load, phase.load_torque, np.zeros(len(load.a)))
    )


def _held_response(
    system: StateSpace, torque: np.ndarray, initial_state: np.ndarray
) -> np.ndarray:
    """Return the output at t_0..t_N for an input held over each period."""
    sampled = discretise_zoh(system, PERIOD_S)
    return _response(sampled.a, system.c[0], np.outer(torque, sampled.b[:, 0]), initial_state)


def _response(
    transition: np.ndarray, output: np.ndarray, forcing: np.ndarray, initial_state: np.ndarray
) -> np.ndarray:
    """Return output . x_k for x_(k+1) = transition x_k + forcing_k; w_d has no feedthrough."""
    state = initial_state
    outputs = [output @ state]
    for push in forcing:
        state = transition @ state + push
        outputs.append(output @ state)
    return np.array(outputs)
