# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The sampled model that the predictive controllers and their observers share.

Variants have further states: disturbances, or an engine that is commanded.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.names import Names
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.driveline_model import STATES as DRIVELINE_STATES
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.printed import ACTUATOR

_ACTUATOR_SIZE = len(ACTUATOR.poles)
TRANSMISSION_STATES = (
    DRIVELINE_STATES
    + Names(tuple(f'actuator_{index}' for index in range(1, _ACTUATOR_SIZE + 1)))
    + Names(('delayed_request',))
)
"""States of the driveline in rad/s and rad, those of G_a, the request of the period before."""
STATES = len(TRANSMISSION_STATES)
"""Number of states without disturbances."""
MEASURED = DRIVELINE_STATES['twist']
"""Number of measured states, which come first: w_m, w_p and w_r in rad/s."""
REQUEST, ENGINE_TORQUE, LOAD_TORQUE = range(3)
"""
Indices of the inputs in N m: saturated clutch torque request, C_m, C_load, held over a period.
"""
SLIP_SPEED, SLIP_ACCELERATION, TORSION_SPEED = range(3)
"""
Indices of the outputs at the start of a period: w_d in rad/s, dw_d/dt in rad/s^2, w_sr in rad/s.
"""
DRIVELINE = slice(0, len(DRIVELINE_STATES))
ACTUATOR_STATES = slice(DRIVELINE.stop, DRIVELINE.stop + _ACTUATOR_SIZE)
DELAYED_REQUEST = TRANSMISSION_STATES['delayed_request']
"""Places of the states of the driveline, of G_a and of the request in TRANSMISSION_STATES."""


@dataclass(frozen=True, eq=False)
class TransmissionModel(StateSpace):
    """
    x_(k+1) = a x_k + b u_k, y_k = c x_k + d u_k at 10 ms, exact for the clutch while it slips.

    Disturbances that are estimated follow the states of driveline, actuator and delay as
    constants.
    Columns of b (n, 3) and d (3, 3) are REQUEST, ENGINE_TORQUE, LOAD_TORQUE; rows of c (3, n) and
    d are SLIP_SPEED, SLIP_ACCELERATION, TORSION_SPEED.
    """

    period_s: float | None = PERIOD_S
    clutch: np.ndarray = field(kw_only=True)
    """Effect of 1 N m of C_f, held over a period, beside the actuator's torque, (n,)."""
    states: Names = TRANSMISSION_STATES
    """Names of the states, (n,)."""

    @property
    def disturbances(self) -> int:
        """Number of constant disturbances, which follow the other states."""
        return len(self.a) - STATES

    def at_rest(
        self, speeds: tuple[float, float, float], twist: float, request: float
    ) -> np.ndarray:
        """Return x (n,) with `speeds` w_m, w_p, w_r, actuator at rest on `request` in N m."""
        actuator = ACTUATOR.to_state_space()
        state = np.zeros(len(self.a))
        state[:MEASURED], state[self.states['twist']] = speeds, twist
        state[ACTUATOR_STATES] = np.linalg.solve(actuator.a, -actuator.b[:, 0] * request)
        state[DELAYED_REQUEST] = request
        return state

    def without_load(self) -> 'TransmissionModel':
        """Return the model with C_load as an input without effect, for a load that is unknown."""
        b, d = self.b.copy(), self.d.copy()
        b[:, LOAD_TORQUE], d[:, LOAD_TORQUE] = 0.0, 0.0
        return replace(self, b=b, d=d)


def transmission_model(
    driveline: DrivelineParameters, wear_gain: float = 1.0, *, delay: bool = True
) -> TransmissionModel:
    """
    Return the exact sampled model of driveline (Section 1.5), G_a(s) and delay (Section 1.4.2).

    Its states are TRANSMISSION_STATES; the delay is one period. The clutch
    transmits `wear_gain` times the actuator's torque. Without `delay` it is the plant of Section
    3.2.1.3, P_2 G_a: the request acts at once, and the last state drives nothing.
    """
    plant, actuator = driveline_matrices(driveline), ACTUATOR.to_state_space()
    torques, none = plant.torques, np.zeros((1, len(actuator.a)))
    clutch = wear_gain * plant.b[:, torques.column('clutch_torque')]
    uncoupled = np.zeros((len(actuator.a), len(plant.a)))
    a = np.block([[plant.a, clutch @ actuator.c], [uncoupled, actuator.a]])
    b = np.zeros((len(a), 3))
    b[ACTUATOR_STATES, REQUEST] = actuator.b[:, 0]
    b[DRIVELINE, ENGINE_TORQUE] = plant.b[:, torques['engine_torque']]
    b[DRIVELINE, LOAD_TORQUE] = plant.b[:, torques['load_torque']]
    slip, torsion = (
        np.hstack([plant.c[plant.outputs.column(name)], none])
        for name in ('slip_speed', 'torsion_speed')
    )
    outputs = np.vstack([slip, slip @ a, torsion])
    feedthrough = np.vstack([np.zeros((1, 3)), slip @ b, np.zeros((1, 3))])
    sampled = discretise_zoh(StateSpace(a, b, outputs, feedthrough), PERIOD_S)
    held_clutch = discretise_zoh(plant, PERIOD_S).b[:, torques['clutch_torque']]
    return _with_last_request(sampled, held_clutch, delay=delay)


def _with_last_request(
    sampled: StateSpace, clutch: np.ndarray, *, delay: bool
) -> TransmissionModel:
    """Append the request of the period before as a state, which acts in place of REQUEST."""
    a, b, d = np.zeros((STATES, STATES)), sampled.b.copy(), sampled.d.copy()
    before = slice(0, DELAYED_REQUEST)
    a[before, before], through = sampled.a, np.zeros((len(sampled.c), 1))
    if delay:
        a[before, DELAYED_REQUEST], through[:, 0] = b[:, REQUEST], d[:, REQUEST]
        b[:, REQUEST], d[:, REQUEST] = 0.0, 0.0
    b = np.vstack([b, [1.0, 0.0, 0.0]])
    c = np.hstack([sampled.c, through])
    return TransmissionModel(
        a, b, c, d, clutch=np.concatenate([clutch, np.zeros(STATES - len(clutch))])
    )


def with_engine(model: TransmissionModel, lag_share: float) -> TransmissionModel:
    """
    Return `model` with two more states, the driver's demand and the deviation before, in N m.

    Its input ENGINE_TORQUE is the requested deviation u. With s = `lag_share`, the share that
    comes about within a period (1 without a lag), C_m = demand + (1 - s) deviation + s u over the
    period, and the deviation after it is (1 - s) deviation + s u. The demand stays as it is.
    """
    kept = 1.0 - lag_share
    states = len(model.a)
    engine, through = model.b[:, ENGINE_TORQUE], model.d[:, ENGINE_TORQUE]
    a = np.zeros((states + 2, states + 2))
    a[:states] = np.column_stack([model.a, engine, kept * engine])
    a[states, states], a[-1, -1] = 1.0, kept
    b = np.vstack([model.b, np.zeros((2, 3))])
    b[:states, ENGINE_TORQUE], b[-1, ENGINE_TORQUE] = lag_share * engine, lag_share
    d = model.d.copy()
    d[:, ENGINE_TORQUE] = lag_share * through
    c = np.column_stack([model.c, through, kept * through])
    clutch = np.concatenate([model.clutch, np.zeros(2)])
    names = model.states + Names(('torque_demand', 'torque_deviation'))
    return TransmissionModel(a, b, c, d, clutch=clutch, states=names)
