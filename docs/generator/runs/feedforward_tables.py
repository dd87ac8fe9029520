# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of the design of the feedforward and of its residuals."""

import math
from collections.abc import Sequence
from dataclasses import replace
from unittest.mock import patch

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.metric import Metrics
from ddct_bringup.metrics.values import compute_metrics
from ddct_bringup.run.headless import run_headless
from ddct_controllers import feedforward
from ddct_controllers.design.analysis.loops import sampled_plant
from ddct_controllers.design.feedforward import TORQUE_RATE_WEIGHT, design_feedforward
from ddct_controllers.design.state_space import frequency_response, poles_rad_s
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rad_s_from_rpm
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.driveline_model import engine_to_slip, load_to_slip
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.static_torque import constant_slip_torque
from ddct_plant.program.table import Table
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

SCENARIO = load_scenario('thesis')
DRIVELINE = SCENARIO.driveline
NEARLY_EXACT = 1e-4
"""Weight of torque rates that leads to nearly full compensation."""
CONTROLLERS = ('pi', 'ls1', 'ls2', 'ls3', 'ls8', 'hinf1', 'hinf2', 'hinf3')
ARCHITECTURES = ('base', 'feedforward', 'feedforward_tanh')
_WEIGHTS = (NEARLY_EXACT, 0.003, 0.01, 0.02, TORQUE_RATE_WEIGHT, 0.06, 0.1, 0.3)
_FREQUENCIES_HZ = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 2.93, 5.0)
_STATIC_GAINS = [constant_slip_torque(DRIVELINE, *unit) for unit in ((1.0, 0.0), (0.0, 1.0))]
STATIC = StateSpace(
    np.zeros((0, 0)), np.zeros((0, 2)), np.zeros((1, 0)), np.array([_STATIC_GAINS]), PERIOD_S
)
"""Static controller's C_fOL, which has no model of the actuator."""


class _NoFeedback(Controller):
    def reset(self) -> None:
        pass

    def update(self, measurement: Measurement) -> Command:
        return Command(0.0)


def engine_residual(
    model: StateSpace, omega: np.ndarray, driveline: DrivelineParameters
) -> np.ndarray:
    """
    Return (P_1 + P_2 G_a F_1) / P_1, complex, the shape of `omega` in rad/s.

    F_1 = -C_1 is the filter's path from C_m. Everything is sampled at 10 ms, with hold and
    actuator delay, and the driveline has its drags. 0 is full compensation, 1 none at all.
    """
    return _residual(model, 0, engine_to_slip(driveline), omega, driveline)


def load_residual(
    model: StateSpace, omega: np.ndarray, driveline: DrivelineParameters
) -> np.ndarray:
    """
    Return (P_3 + P_2 G_a F_2) / P_3, complex, the shape of `omega` in rad/s.

    F_2 = -C_2 is the filter's path from C_load; sampling and driveline as in `engine_residual`.
    """
    return _residual(model, 1, load_to_slip(driveline), omega, driveline)


def feedforward_tables() -> dict[str, Table]:
    """Return the tables by name."""
    return {'weight': weights(), 'residual': residuals(), 'controllers': controllers()}


def weights() -> Table:
    """Return the results of weights of torque rates without feedback, and of the static law."""
    rows = [(f'{weight:g}', *_without_feedback(weight)) for weight in _WEIGHTS]
    static = run_headless(RunSettings(SCENARIO, 'detailed'), _NoFeedback())
    rows.append(('static law', '-', *_slip_and_deviations(static)))
    deviations = ('σ w_sr, rpm', 'σ A_x, m/s²')
    headers = ('ρ, rad/s per N m/s', 'damping', 'w_d at 0.6 s, rad/s', *deviations)
    return Table('The choice of the weight', headers, rows)


def residuals() -> Table:
    """Return the residuals of C_m over frequency, and those of C_load with our filter."""
    exact = design_feedforward(DRIVELINE, NEARLY_EXACT)
    ours = design_feedforward(DRIVELINE, TORQUE_RATE_WEIGHT)
    rows = []
    for frequency in _FREQUENCIES_HZ:
        omega = np.array([2.0 * math.pi * frequency])
        left = [engine_residual(model, omega, DRIVELINE) for model in (STATIC, exact, ours)]
        left.append(load_residual(ours, omega, DRIVELINE))
        rows.append((f'{frequency:g}', *(f'{abs(value[0]):.4f}' for value in left)))
    ours_text = f'ρ = {TORQUE_RATE_WEIGHT:g}'
    headers = ('static law', f'ρ = {NEARLY_EXACT:g}', ours_text, f'{ours_text}, C_load')
    return Table('What it leaves', ('frequency, Hz', *headers), rows)


def controllers() -> Table:
    """Return the largest slip error and the deviation of w_sr in three architectures."""
    rows = []
    for name in CONTROLLERS:
        cells: list[str] = []
        for architecture in ARCHITECTURES:
            trajectory = run_headless(RunSettings(SCENARIO, architecture), name)
            error = trajectory.slip_reference[:, 0] - trajectory.slip_speed
            deviation = _metrics(trajectory)['torsion_speed_std_rpm']
            cells += [f'{np.abs(error).max():.1f}', f'{deviation:.2f}']
        rows.append((name, *cells))
    headers = [head for each in ARCHITECTURES for head in (f'{each}, peak', 'σ w_sr')]
    return Table('Controllers', ('controller', *headers), rows)


def _without_feedback(weight: float) -> Sequence[str]:
    model = design_feedforward(DRIVELINE, weight)
    with patch.object(feedforward, 'design_feedforward', lambda _: model):
        trajectory = run_headless(RunSettings(SCENARIO, 'feedforward'), _NoFeedback())
    return f'{_lowest_damping(model):.2f}', *_slip_and_deviations(trajectory)


def _slip_and_deviations(trajectory: Trajectory) -> tuple[str, ...]:
    found = _metrics(trajectory)
    return (
        f'{trajectory.slip_speed[SCENARIO.control_start_step]:.1f}',
        f'{found["torsion_speed_std_rpm"]:.2f}',
        f'{found["acceleration_std_m_s2"]:.3f}',
    )


def _metrics(trajectory: Trajectory) -> Metrics:
    return compute_metrics(
        trajectory,
        control_start_s=SCENARIO.control_start_s,
        score_window_s=SCENARIO.score_window_s,
    )


def _lowest_damping(model: StateSpace) -> float:
    poles = poles_rad_s(model)
    slow = poles[(np.abs(poles) < 40.0) & (poles.imag > 0.0)]
    return float(np.min(-slow.real / np.abs(slow)))


def _residual(
    model: StateSpace,
    column: int,
    disturbance_path: FactoredTransferFunction,
    omega: np.ndarray,
    driveline: DrivelineParameters,
) -> np.ndarray:
    path = replace(model, b=model.b[:, [column]], d=model.d[:, [column]])
    uncompensated = discretise_zoh(disturbance_path.to_state_space(), PERIOD_S)
    compensation = rad_s_from_rpm(frequency_response(sampled_plant(driveline), omega))
    compensation = compensation * frequency_response(path, omega)
    return 1.0 + compensation / frequency_response(uncompensated, omega)
