# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Computed values for the numbers of Chapter 1: driveline, actuator, load, feedforward."""

import dataclasses
import math
from collections.abc import Mapping
from functools import cache

import numpy as np

from ddct_bringup.identification.coefficients import PrintedCoefficients
from ddct_bringup.identification.fit import identify_driveline, predict_left_out
from ddct_bringup.reproduction.numbers.thesis_number import Value
from ddct_bringup.reproduction.study_run import THESIS_SCENARIO, thesis_run
from ddct_bringup.reproduction.values.controller_values import numbers_of
from ddct_plant.linear.lti import FactoredTransferFunction
from ddct_plant.models.driveline_model import (
    STATES,
    clutch_to_slip,
    driveline_matrices,
    engine_to_slip,
    load_to_slip,
)
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.printed import (
    ACTUATOR,
    CLUTCH_TO_SLIP,
    CLUTCH_TO_SLIP_AS_PRINTED,
    ENGINE_TO_SLIP,
    LOAD_TO_SLIP,
)
from ddct_plant.simplified.elementary import elementary_slip
from ddct_plant.simplified.plants import (
    SimplifiedPlant,
    SlipPhase,
    lti_slip,
    state_space_slip,
)

SIMPLIFIED_PLANTS: Mapping[str, SimplifiedPlant] = {
    'elementary blocks': elementary_slip,
    'state space': state_space_slip,
    'LTI': lti_slip,
}
"""Simplified models of Section 1.5.1 by name."""


def plant_values() -> dict[str, Value | None]:
    """Return the values by the ids of the gate's file."""
    identification = identify_driveline()
    driveline = identification.parameters
    return {
        **{
            f'{fit.transfer_function.lower()}.{fit.coefficient}': fit.computed
            for fit in identification.coefficients
        },
        'p1.gain': engine_to_slip(driveline).gain,
        'p2.zero c from the others': predict_left_out(
            PrintedCoefficients(CLUTCH_TO_SLIP_AS_PRINTED), 'P2', 'zero c'
        )[0],
        **_shared_poles(driveline),
        # the gain for G_a(0) = 1 with these zeros and poles
        'actuator.gain': ACTUATOR.gain / float(ACTUATOR.at(np.array(0.0)).real),
        'engine.rise end': THESIS_SCENARIO.engine.time_s[-1],
        'driveline.ratio': driveline.values()['total_ratio'],
        **_equations(driveline),
        **_compensators(),
    }


def _shared_poles(driveline: DrivelineParameters) -> dict[str, Value]:
    """Return the poles of P_3, which by Section 1.5 are those of P_2 without the one at 0."""
    (a,), (b, c) = (numbers_of(factor) for factor in load_to_slip(driveline).denominator)
    return {'p3.pole a': a, 'p3.pole b': b, 'p3.pole c': c}


def _equations(driveline: DrivelineParameters) -> dict[str, Value]:
    """Return the corrections of the equations of Section 1.5 that the printed P_2 requires."""
    model = driveline_matrices(driveline)
    slip = dict(zip(STATES, model.output('slip_speed').tolist(), strict=True))
    minus = slip == dict.fromkeys(STATES, 0.0) | {'engine_speed': 1.0, 'shaft_speed': -1.0}
    undamped = clutch_to_slip(dataclasses.replace(driveline, shaft_damping=0.0))
    (pole,) = numbers_of(undamped.denominator[1])
    return {
        'slip speed': 'w_m - w_p' if minus else 'not w_m - w_p',
        'w_r equation': _wheel_coupling(model.a, driveline),
        'p2.pole a without c_prim': pole + 0.0,  # no minus zero,
    }


def _wheel_coupling(a: np.ndarray, driveline: DrivelineParameters) -> str:
    """Return the coefficient of w_p in the w_r equation that leaves no growing pole, as text."""
    growth = {}
    for symbol, inertia in (('J_p', driveline.shaft_inertia), ('J_v', driveline.vehicle_inertia)):
        changed = a.copy()
        changed[STATES['wheel_speed'], STATES['shaft_speed']] = (
            driveline.halfshaft_damping / driveline.gear.across(inertia)
        )
        growth[symbol] = float(np.max(np.linalg.eigvals(changed).real))
    return f'c_sa/({min(growth, key=lambda symbol: growth[symbol])} tau)'


def _compensators() -> dict[str, Value]:
    """Return whether C_1 = P_1/(P_2 G_a) and C_2 = P_3/(P_2 G_a) can be built (Section 1.6.2)."""
    inverted = CLUTCH_TO_SLIP.factored() * ACTUATOR
    return {
        f'feedforward.{name}': _buildable(path.factored(), inverted)
        for name, path in (('C1', ENGINE_TO_SLIP), ('C2', LOAD_TO_SLIP))
    }


def _buildable(path: FactoredTransferFunction, inverted: FactoredTransferFunction) -> str:
    """Return why path / inverted cannot be realised, as text."""
    order = len(path.poles) - len(path.zeros) - len(inverted.poles) + len(inverted.zeros)
    unstable = int(np.count_nonzero(inverted.zeros.real > 0.0))
    proper = 'improper, ' if order < 0 else ''
    return f'{proper}{unstable} unstable poles'


def deviation_bound_percent() -> float:
    """Return the smallest power of ten in % above all `deviations`."""
    return 10.0 ** math.ceil(math.log10(100.0 * max(deviations(SIMPLIFIED_PLANTS).values())))


def plant_slips(plants: Mapping[str, SimplifiedPlant]) -> dict[str, np.ndarray]:
    """Return w_d in rad/s of each model under the torques of the PI's run, (N+1,)."""
    return {name: _slip(plant) for name, plant in plants.items()}


@cache
def _slip(plant: SimplifiedPlant) -> np.ndarray:
    run = thesis_run('pi', 'detailed', 1.0).trajectory
    states = run.engine_speed, run.primary_shaft_speed, run.wheel_speed, run.driveshaft_position
    start = np.array([each[0] for each in states])
    torques = run.engine_torque[:-1], run.clutch_torque[:-1], run.load_torque[:-1]
    return plant(THESIS_SCENARIO.driveline, SlipPhase(*torques, start))


def deviations(plants: Mapping[str, SimplifiedPlant]) -> dict[str, float]:
    """Return the largest difference of w_d of each model from the detailed one, over its peak."""
    detailed = thesis_run('pi', 'detailed', 1.0).trajectory.slip_speed
    return {
        name: float(np.abs(slip - detailed).max() / np.abs(detailed).max())
        for name, slip in plant_slips(plants).items()
    }
