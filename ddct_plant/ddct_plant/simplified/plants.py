"""
The three simplified plants of Section 1.5.1, to compare with the detailed one (Figure 1.23).

All take the same torques: C_m and C_load held over each 10 ms period, C_f piecewise linear between
11 points of it. Here are the two that are sums of three one-input systems, stepped exactly;
`elementary` has the one that integrates a block diagram.
"""

from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S, SUBSTEPS
from ddct_plant.linear.lti import (
    FactoredTransferFunction,
    StateSpace,
    discretise_zoh,
    lift_piecewise_linear,
)
from ddct_plant.models.driveline_model import (
    clutch_to_slip,
    driveline_matrices,
    engine_to_slip,
    load_to_slip,
)
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.printed import CLUTCH_TO_SLIP, ENGINE_TO_SLIP, LOAD_TO_SLIP


class SimplifiedPlant(ABC):
    """A plant from the three torques to the slip speed."""

    def simulate(
        self,
        engine_torque: np.ndarray,
        clutch_points: np.ndarray,
        load_torque: np.ndarray,
        initial_state: np.ndarray,
    ) -> np.ndarray:
        """
        Return w_d in rad/s at t_0..t_N, (N + 1,), for torques in N m over N periods.

        `engine_torque` and `load_torque` are (N,), `clutch_points` (N, 11), `initial_state` is
        [w_m, w_p, w_r, theta_sr]. Raise ParameterError for other shapes.
        """
        periods = np.size(engine_torque)
        given = {
            'engine_torque': (engine_torque, (periods,)),
            'clutch_points': (clutch_points, (periods, SUBSTEPS + 1)),
            'load_torque': (load_torque, (periods,)),
            'initial_state': (initial_state, (4,)),
        }
        for name, (values, shape) in given.items():
            if np.shape(values) != shape:
                raise ParameterError(f'{name} has shape {np.shape(values)}, it must be {shape}')
        return self._slip_speed(*(np.asarray(values, float) for values, _ in given.values()))

    @abstractmethod
    def _slip_speed(
        self,
        engine_torque: np.ndarray,
        clutch_points: np.ndarray,
        load_torque: np.ndarray,
        initial_state: np.ndarray,
    ) -> np.ndarray:
        """Return what `simulate` does, for arrays of the right shape."""


class StateSpacePlant(SimplifiedPlant):
    """
    Three state-space blocks (A, B(:, i), C, D(:, i)), one per torque, added up (Figure 1.21).

    Each has four states of its own. The initial condition goes into the block of C_f alone: in
    more than one of them it would count twice.
    """

    def __init__(self, parameters: DrivelineParameters) -> None:
        """Split the driveline by input, and keep the first output, w_d."""
        model = driveline_matrices(parameters)
        self._blocks = [
            StateSpace(model.a, model.b[:, i : i + 1], model.c[:1], model.d[:1, i : i + 1])
            for i in range(3)
        ]

    def _slip_speed(
        self,
        engine_torque: np.ndarray,
        clutch_points: np.ndarray,
        load_torque: np.ndarray,
        initial_state: np.ndarray,
    ) -> np.ndarray:
        engine, clutch, load = self._blocks
        return (
            _held_response(engine, engine_torque)
            + _points_response(clutch, clutch_points, initial_state)
            + _held_response(load, load_torque)
        )


class LtiPlant(SimplifiedPlant):
    """
    Three transfer functions P_1, P_2, P_3 added up (Figure 1.22).

    They start from zero and hold no initial condition, so the free response C e^(A t) x_0 of
    the driveline is a term of its own.
    """

    def __init__(
        self,
        transfer_functions: Sequence[FactoredTransferFunction],
        parameters: DrivelineParameters,
    ) -> None:
        """Take P_1, P_2, P_3 and the driveline whose free response is added."""
        self._blocks = [function.to_state_space() for function in transfer_functions]
        model = driveline_matrices(parameters)
        self._free = StateSpace(model.a, np.zeros((4, 1)), model.c[:1], np.zeros((1, 1)))

    def _slip_speed(
        self,
        engine_torque: np.ndarray,
        clutch_points: np.ndarray,
        load_torque: np.ndarray,
        initial_state: np.ndarray,
    ) -> np.ndarray:
        engine, clutch, load = self._blocks
        return (
            _held_response(engine, engine_torque)
            + _points_response(clutch, clutch_points, np.zeros(len(clutch.a)))
            + _held_response(load, load_torque)
            + _held_response(self._free, np.zeros(len(engine_torque)), initial_state)
        )


def lti_plant(parameters: DrivelineParameters) -> LtiPlant:
    """Return the LTI plant whose transfer functions are those of `parameters`, not rounded."""
    functions = engine_to_slip(parameters), clutch_to_slip(parameters), load_to_slip(parameters)
    return LtiPlant(functions, parameters)


def printed_lti_plant(parameters: DrivelineParameters) -> LtiPlant:
    """
    Return the LTI plant with the thesis's rounded P_1, P_2, P_3 (Section 1.6.2).

    C_m P_1 and C_f P_2 nearly cancel, so rounding costs more than its digits: 0.23 % of the slip
    peak after the 1.1 s of Figure 1.23, growing with time.
    """
    printed = ENGINE_TO_SLIP, CLUTCH_TO_SLIP, LOAD_TO_SLIP
    return LtiPlant([function.factored() for function in printed], parameters)


def _held_response(
    system: StateSpace, torque: np.ndarray, initial_state: np.ndarray | None = None
) -> np.ndarray:
    """Return the output at t_0..t_N for an input held over each period."""
    sampled = discretise_zoh(system, PERIOD_S)
    start = np.zeros(len(system.a)) if initial_state is None else initial_state
    return _response(sampled.a, system.c[0], np.outer(torque, sampled.b[:, 0]), start)


def _points_response(
    system: StateSpace, points: np.ndarray, initial_state: np.ndarray
) -> np.ndarray:
    """Return the output at t_0..t_N for an input piecewise linear between 11 points."""
    transition, nodes = lift_piecewise_linear(system.a, system.b, PERIOD_S, SUBSTEPS)
    return _response(transition, system.c[0], points @ nodes.T, initial_state)


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
