"""What effect of a disturbance on the slip the feedforward leaves, and what the page says."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ddct_controllers.design.analysis.loops import sampled_plant
from ddct_controllers.design.feedforward import design_feedforward
from ddct_controllers.design.state_space import frequency_response
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rad_s_from_rpm
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace, discretise_zoh
from ddct_plant.models.driveline_model import engine_to_slip, load_to_slip
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.static_torque import constant_slip_torque
from ddct_plant.scenario.file import load_scenario

PAGE = Path(__file__).resolve().parents[3] / 'docs' / 'controllers' / 'feedforward.md'
DRIVELINE = load_scenario('thesis').driveline
NEARLY_EXACT = 1e-4
FILTER = design_feedforward(DRIVELINE)
STATIC_GAINS = [constant_slip_torque(DRIVELINE, *unit) for unit in ((1.0, 0.0), (0.0, 1.0))]
STATIC = StateSpace(
    np.zeros((0, 0)), np.zeros((0, 2)), np.zeros((1, 0)), np.array([STATIC_GAINS]), PERIOD_S
)
"""The static controller's C_fOL, which knows of no actuator."""


def engine_residual(
    feedforward: StateSpace, omega: np.ndarray, driveline: DrivelineParameters
) -> np.ndarray:
    """
    Return (P_1 + P_2 G_a F_1) / P_1, complex, the shape of `omega` in rad/s.

    F_1 = -C_1 is the filter's path from C_m. Everything is sampled at 10 ms, with hold and
    actuator delay, and the driveline has its drags. 0 is full compensation, 1 none at all.
    """
    return _residual(feedforward, 0, engine_to_slip(driveline), omega, driveline)


def load_residual(
    feedforward: StateSpace, omega: np.ndarray, driveline: DrivelineParameters
) -> np.ndarray:
    """Return (P_3 + P_2 G_a F_2) / P_3, F_2 = -C_2 being the path from C_load; see above."""
    return _residual(feedforward, 1, load_to_slip(driveline), omega, driveline)


def _residual(
    feedforward: StateSpace,
    column: int,
    disturbance_path: FactoredTransferFunction,
    omega: np.ndarray,
    driveline: DrivelineParameters,
) -> np.ndarray:
    path = StateSpace(
        feedforward.a,
        feedforward.b[:, [column]],
        feedforward.c,
        feedforward.d[:, [column]],
        feedforward.period_s,
    )
    uncompensated = discretise_zoh(disturbance_path.to_state_space(), PERIOD_S)
    compensation = rad_s_from_rpm(frequency_response(sampled_plant(driveline), omega))
    compensation = compensation * frequency_response(path, omega)
    return 1.0 + compensation / frequency_response(uncompensated, omega)


def table(name: str) -> list[list[str]]:
    """Return the cells of the rows below a table's marker, its head and rule left out."""
    after = PAGE.read_text(encoding='utf-8').split(f'<!-- feedforward: {name} -->\n')[1]
    lines = after.split('\n\n')[0].splitlines()[2:]
    return [[cell.strip(' *') for cell in line.strip('|').split('|')] for line in lines]


def assert_printed(cell: str, value: float) -> None:
    """Check that a cell is the value at the cell's number of decimals."""
    decimals = len(cell.partition('.')[2])
    assert abs(float(cell) - value) <= 0.501 * 10.0**-decimals, (cell, value)


def test_it_compensates_the_engine_torque_better_than_the_static_law_up_to_3_3_hz():
    omega = 2.0 * np.pi * np.append(np.geomspace(0.05, 3.3, 50), 3.4)
    ours = np.abs(engine_residual(FILTER, omega, DRIVELINE))
    static = np.abs(engine_residual(STATIC, omega, DRIVELINE))
    assert np.all(ours[:-1] < static[:-1])
    assert ours[-1] > static[-1]
    assert ours[omega < 2.0 * np.pi].max() < 0.03


def test_it_compensates_the_load_up_to_a_third_of_a_hertz():
    omega = 2.0 * np.pi * np.geomspace(0.05, 0.3, 20)
    assert np.abs(load_residual(FILTER, omega, DRIVELINE)).max() < 0.05


def test_without_a_filter_the_residual_is_one():
    nothing = replace(STATIC, d=np.zeros((1, 2)))
    omega = np.array([1.0, 10.0])
    for residual in (engine_residual, load_residual):
        np.testing.assert_array_equal(residual(nothing, omega, DRIVELINE), [1.0, 1.0])


def test_the_table_of_residuals():
    exact = design_feedforward(DRIVELINE, NEARLY_EXACT)
    for frequency, *cells in table('residual'):
        omega = np.array([2.0 * np.pi * float(frequency)])
        values = [engine_residual(model, omega, DRIVELINE) for model in (STATIC, exact, FILTER)]
        values.append(load_residual(FILTER, omega, DRIVELINE))
        for cell, value in zip(cells, values, strict=True):
            assert_printed(cell, abs(value[0]))
