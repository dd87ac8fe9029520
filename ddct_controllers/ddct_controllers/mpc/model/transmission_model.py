# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The sampled model that the predictive controllers and their observers share.

Variants have further states: disturbances, or an engine that is commanded.
"""

from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import numpy as np

from ddct_plant.base.timebase import PERIOD_S, SUBSTEPS
from ddct_plant.linear.delayed_input import acting_inputs, with_waiting_inputs
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.names import Names
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.actuator import PRINTED_ACTUATOR, ActuatorParameters, at_rest
from ddct_plant.models.driveline_model import STATES as DRIVELINE_STATES
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.printed import ACTUATOR

_ACTUATOR_SIZE = len(ACTUATOR.poles)
_LAST_REQUEST = 'delayed_request'


def transmission_states(waiting: int) -> Names:
    """
    Return the names of the states with so many requests that wait, 1 or more.

    They are those of the driveline in rad/s and rad, those of G_a, and the requests of the
    periods before in N m, that of the last period at the end.
    """
    actuator = tuple(f'actuator_{index}' for index in range(1, _ACTUATOR_SIZE + 1))
    before = tuple(f'{_LAST_REQUEST}_{periods}' for periods in range(waiting, 1, -1))
    return DRIVELINE_STATES + Names((*actuator, *before, _LAST_REQUEST))


TRANSMISSION_STATES = transmission_states(1)
"""States with the printed actuator, whose delay is one period."""
STATES = len(TRANSMISSION_STATES)
"""Their number, without disturbances."""
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
"""Places of the states of the driveline and of G_a."""


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
    actuator: ActuatorParameters = PRINTED_ACTUATOR
    """Actuator of the model."""

    @property
    def transmission(self) -> int:
        """Number of the states of driveline, actuator and delay, which come first."""
        return self.states[_LAST_REQUEST] + 1

    @property
    def disturbances(self) -> int:
        """Number of constant disturbances, which follow the other states."""
        return len(self.a) - self.transmission

    def at_rest(
        self, speeds: tuple[float, float, float], twist: float, request: float
    ) -> np.ndarray:
        """Return x (n,) with `speeds` w_m, w_p, w_r, actuator at rest on `request` in N m."""
        state = np.zeros(len(self.a))
        state[:MEASURED], state[self.states['twist']] = speeds, twist
        state[ACTUATOR_STATES] = at_rest(self.actuator.dynamics(), request)
        state[ACTUATOR_STATES.stop : self.transmission] = request
        return state

    @cached_property
    def without_load(self) -> 'TransmissionModel':
        """The model with C_load as an input without effect, for a load that is unknown."""
        b, d = self.b.copy(), self.d.copy()
        b[:, LOAD_TORQUE], d[:, LOAD_TORQUE] = 0.0, 0.0
        return replace(self, b=b, d=d)


@lru_cache  # runs with equal known settings share one
def transmission_model(
    driveline: DrivelineParameters,
    wear_gain: float = 1.0,
    actuator: ActuatorParameters = PRINTED_ACTUATOR,
) -> TransmissionModel:
    """
    Return the exact sampled model of driveline (Section 1.5), G_a(s) and delay (Section 1.4.2).

    Its states are `transmission_states`. The clutch transmits `wear_gain` times the actuator's
    torque. Without a delay it is the plant of Section 3.2.1.3, P_2 G_a: the request acts at once,
    and the last state drives nothing.
    """
    periods, late = divmod(actuator.delay_substeps, SUBSTEPS)
    plant, lag = driveline_matrices(driveline), actuator.dynamics()
    torques, none = plant.torques, np.zeros((1, len(lag.a)))
    clutch = wear_gain * plant.b[:, torques.column('clutch_torque')]
    uncoupled = np.zeros((len(lag.a), len(plant.a)))
    a = np.block([[plant.a, clutch @ lag.c], [uncoupled, lag.a]])
    b = np.zeros((len(a), 3))
    b[ACTUATOR_STATES, REQUEST] = lag.b[:, 0]
    b[DRIVELINE, ENGINE_TORQUE] = plant.b[:, torques['engine_torque']]
    b[DRIVELINE, LOAD_TORQUE] = plant.b[:, torques['load_torque']]
    slip, torsion = (
        np.hstack([plant.c[plant.outputs.column(name)], none])
        for name in ('slip_speed', 'torsion_speed')
    )
    outputs = np.vstack([slip, slip @ a, torsion])
    feedthrough = np.vstack([np.zeros((1, 3)), slip @ b, np.zeros((1, 3))])
    continuous = StateSpace(a, b, outputs, feedthrough)
    sampled = discretise_zoh(continuous, PERIOD_S)
    acting = acting_inputs(continuous, late, REQUEST)
    of_states, by_request = with_waiting_inputs(sampled.a, acting, periods, at_least=1)
    waiting = len(of_states) - len(a)
    inputs = np.vstack([sampled.b, np.zeros((waiting, 3))])
    inputs[:, REQUEST] = by_request[:, 0]
    held_clutch = discretise_zoh(plant, PERIOD_S).b[:, torques['clutch_torque']]
    return TransmissionModel(
        of_states,
        inputs,
        np.hstack([sampled.c, np.zeros((len(sampled.c), waiting))]),
        sampled.d,
        clutch=np.concatenate([held_clutch, np.zeros(len(of_states) - len(held_clutch))]),
        states=transmission_states(waiting),
        actuator=actuator,
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
    return replace(model, a=a, b=b, c=c, d=d, clutch=clutch, states=names)
