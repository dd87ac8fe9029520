# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Feedforward filters C_1 and C_2 of Section 1.6.2, made proper and stable by model matching."""

from dataclasses import dataclass, replace

import numpy as np

from ddct_controllers.design.state_space import series
from ddct_controllers.linear import DiscreteFilter
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_S, SUBSTEPS
from ddct_plant.linear.delayed_input import acting_inputs, with_waiting_inputs
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.actuator import ActuatorParameters
from ddct_plant.models.driveline_model import TORQUES, driveline_matrices
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.static_torque import constant_slip_torque

TORQUE_RATE_WEIGHT = 0.03
"""
Weight rho in rad/s per N m/s: price of torque beyond the static law.

docs/controllers/launching.md has the argument.
"""

_ENGINE, _CLUTCH, _LOAD = TORQUES.places('engine_torque', 'clutch_torque', 'load_torque')


def design_feedforward(
    driveline: DrivelineParameters,
    actuator: ActuatorParameters,
    *,
    torque_rate_weight: float = TORQUE_RATE_WEIGHT,
) -> StateSpace:
    """
    Return the filter from [C_m, C_load] to the torque request, all N m, sampled at 10 ms.

    C_1 = P_1/(P_2 G_a) and C_2 = P_3/(P_2 G_a) as printed are unstable, because G_a has zeros in
    the right half-plane, and C_1 is not proper. Here the request u minimises, over all stable
    causal filters, the sum over all periods of
    w_d^2 + rho^2 [d/dt (u - C_fOL)]^2 for a C_m that becomes a ramp and a C_load that becomes a
    step, in the sampled plant with hold and actuator. w_d is the slip left over,
    P_1 C_m + P_3 C_load + P_2 G_a u; C_fOL the torque of the static controller. Raise DdctError
    when the driveline has no such filter.
    """
    problem = _problem(driveline, actuator, torque_rate_weight)
    state_gain, disturbance_gain = _optimal_gains(problem)
    engine, engine_step, load = disturbance_gain
    c = -np.append(state_gain, -engine_step)[np.newaxis]
    d = -np.array([[engine + engine_step, load]])
    states = len(problem.a)
    a = np.pad(problem.a, (0, 1))
    a[:states] += problem.b @ c
    b = np.vstack([problem.g[:, [0, 2]] + problem.b @ d, [1.0, 0.0]])
    model = StateSpace(a, b, c, d, PERIOD_S)
    largest = float(np.max(np.abs(np.linalg.eigvals(model.a))))
    if not largest < 1.0:
        raise _no_filter(f'its largest pole would be at |z| = {largest:.9f}')
    return model


def state_at_rest(model: StateSpace, engine_torque: float) -> np.ndarray:
    """
    Return the filter's state, (n,), before a run that starts with this C_m in N m.

    The driveline and the actuator in it are at rest. Its last state, the C_m of the period before,
    is that of now, because the torque that a run starts with is no ramp.
    """
    state = np.zeros(len(model.a))
    state[-1] = engine_torque
    return state


class Feedforward:
    """
    u = -C_1 C_m - C_2 C_load with proper, stable C_1 and C_2, as it runs.

    C_1 and C_2 are negative, as P_2 is, so that the request is about 0.88 C_m, with a lead that
    compensates the lag of the actuator.
    """

    def __init__(self, driveline: DrivelineParameters, actuator: ActuatorParameters) -> None:
        """Design the filter for a driveline and an actuator."""
        self._model = design_feedforward(driveline, actuator)
        self._filter = DiscreteFilter(self._model)
        self._started = False

    def update(self, engine_torque: float, load_torque: float) -> float:
        """Return the request in N m for C_m and C_load in N m of the coming period."""
        if not self._started:
            self._filter.reset(state_at_rest(self._model, engine_torque))
            self._started = True
        return self._filter.update(engine_torque, load_torque)


@dataclass(frozen=True, eq=False)
class _Problem:
    """
    x_(k+1) = a x + b u + g w, w_(k+1) = s w; minimise the sum of |c x + d u + f w|^2.

    w = [C_m, C_m less that of the period before, C_load]: all is known at k, no future values.
    """

    a: np.ndarray
    b: np.ndarray
    g: np.ndarray
    s: np.ndarray
    c: np.ndarray
    d: np.ndarray
    f: np.ndarray


def _problem(
    driveline: DrivelineParameters, actuator: ActuatorParameters, torque_rate_weight: float
) -> _Problem:
    periods, late = divmod(actuator.delay_substeps, SUBSTEPS)
    continuous = series(_actuator_stage(actuator.dynamics()), _relative_driveline(driveline))
    plant = discretise_zoh(continuous, PERIOD_S)
    states = len(plant.a)
    # The last state is u of k - 1.
    acting = acting_inputs(continuous, late, _CLUTCH)
    a, b = with_waiting_inputs(plant.a, acting, periods, at_least=1)
    size = len(a)
    g = np.zeros((size, 3))
    g[:states, [0, 2]] = plant.b[:, [_ENGINE, _LOAD]]
    c, d, f = np.zeros((2, size)), np.zeros((2, 1)), np.zeros((2, 3))
    c[0, :states] = plant.c[0]
    rate = torque_rate_weight / PERIOD_S
    c[1, size - 1], d[1, 0] = -rate, rate
    f[1, 1] = -rate * constant_slip_torque(driveline, 1.0, 0.0)
    ramp = np.array([[1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    return _Problem(a, b, g, ramp, c, d, f)


def _actuator_stage(actuator: StateSpace) -> StateSpace:
    """Return G_a for the request, second of three inputs, with C_m and C_load passed through."""
    states = len(actuator.a)
    b, c = np.zeros((states, 3)), np.zeros((3, states))
    b[:, [_CLUTCH]], c[_CLUTCH] = actuator.b, actuator.c[0]
    return StateSpace(actuator.a, b, c, np.diag([1.0, 0.0, 1.0]))


def _relative_driveline(driveline: DrivelineParameters) -> StateSpace:
    """
    Return x = y = [w_d, w_sr, theta_sr] for [C_m, C_f, C_load]: the driveline of Section 1.5.

    The drags c_m and c_prim are left out: without them the common speed acts on nothing, and with
    them the filter would keep it for minutes (the pole of C_1 at -0.0059 rad/s).
    """
    free = driveline_matrices(replace(driveline, engine_damping=0.0, shaft_damping=0.0))
    twist = np.eye(len(free.a))[free.states['twist']]
    relative = np.vstack([free.c, twist])
    slip, torsion, last = np.eye(len(relative))
    with_shaft_at_rest = np.zeros((len(free.a), len(relative)))
    with_shaft_at_rest[free.states['engine_speed']] = slip
    with_shaft_at_rest[free.states['wheel_speed']] = -torsion
    with_shaft_at_rest[free.states['twist']] = last
    a, b = relative @ free.a @ with_shaft_at_rest, relative @ free.b
    return StateSpace(a, b, np.eye(3), np.zeros((3, 3)))


def _optimal_gains(problem: _Problem) -> tuple[np.ndarray, np.ndarray]:
    """
    Return K (n,) and K_w (3,) of the optimal u = -K x - K_w w.

    With the value x' P x + 2 x' X w + ..., P solves the Riccati equation and X the linear one
    X = A_c' X S + A_c' P G + C_c' F, A_c = A - B K, C_c = C - D K. That has a solution although
    ramps do not decay, because A_c does.
    """
    # Only here: the architectures without feedforward need not wait for its import.
    from scipy.linalg import solve_discrete_are

    p = problem
    try:
        value = solve_discrete_are(p.a, p.b, p.c.T @ p.c, p.d.T @ p.d, s=p.c.T @ p.d)
    except (np.linalg.LinAlgError, ValueError) as error:
        raise _no_filter(str(error)) from error
    weight = (p.d.T @ p.d + p.b.T @ value @ p.b)[0, 0]
    state_gain = (p.b.T @ value @ p.a + p.d.T @ p.c)[0] / weight
    closed, output = p.a - p.b * state_gain, p.c - p.d * state_gain
    constant = closed.T @ value @ p.g + output.T @ p.f
    equations = np.eye(constant.size) - np.kron(closed.T, p.s.T)
    coupling = np.linalg.solve(equations, constant.ravel()).reshape(constant.shape)
    disturbance_gain = (p.b.T @ (value @ p.g + coupling @ p.s) + p.d.T @ p.f)[0] / weight
    return state_gain, disturbance_gain


def _no_filter(reason: str) -> DdctError:
    return DdctError(
        f'feedforward: no stable filter for this driveline ({reason}): check driveline.* in the '
        'scenario, or choose the architecture base'
    )
