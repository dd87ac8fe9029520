"""docs/controllers/feedforward.md says what the code computes, to the last printed digit."""

import re
from pathlib import Path

import numpy as np
import pytest

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.metrics import Metrics, compute_metrics
from ddct_controllers import feedforward
from ddct_controllers.design.feedforward import TORQUE_RATE_WEIGHT, design_feedforward
from ddct_controllers.design.state_space import poles_rad_s
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_plant.linear.lti import StateSpace
from ddct_plant.models.static_torque import constant_slip_torque
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

pytestmark = pytest.mark.slow

PAGE = Path(__file__).resolve().parents[4] / 'docs' / 'controllers' / 'feedforward.md'
SCENARIO = load_scenario('thesis')
DRIVELINE = SCENARIO.driveline
NEARLY_EXACT = 1e-4


class NoFeedback(Controller):
    def reset(self) -> None:
        pass

    def update(self, measurement: Measurement) -> Command:
        return Command(0.0)


def table(name: str) -> list[list[str]]:
    """Return the cells of the rows below a table's marker, its head and rule left out."""
    after = PAGE.read_text(encoding='utf-8').split(f'<!-- feedforward: {name} -->\n')[1]
    lines = after.split('\n\n')[0].splitlines()[2:]
    return [[cell.strip(' *') for cell in line.strip('|').split('|')] for line in lines]


def assert_printed(cell: str, value: float) -> None:
    """Check that a cell is the value at the cell's number of decimals."""
    decimals = len(cell.partition('.')[2])
    assert abs(float(cell) - value) <= 0.501 * 10.0**-decimals, (cell, value)


def metrics(trajectory: Trajectory) -> Metrics:
    return compute_metrics(
        trajectory,
        control_start_s=SCENARIO.control_start_s,
        score_window_s=SCENARIO.score_window_s,
    )


def lowest_damping(model: StateSpace) -> float:
    poles = poles_rad_s(model)
    slow = poles[(np.abs(poles) < 40.0) & (poles.imag > 0.0)]
    return float(np.min(-slow.real / np.abs(slow)))


def test_the_table_of_weights(monkeypatch):
    rows = table('weight')
    assert str(TORQUE_RATE_WEIGHT) in [row[0] for row in rows]
    for weight, damping, *cells in rows:
        if weight == 'static law':
            settings = RunSettings(SCENARIO, 'detailed')
        else:
            model = design_feedforward(DRIVELINE, float(weight))
            monkeypatch.setattr(feedforward, 'design_feedforward', lambda _, model=model: model)
            settings = RunSettings(SCENARIO, 'feedforward')
            assert_printed(damping, lowest_damping(model))
        trajectory = run_headless(settings, NoFeedback())
        found = metrics(trajectory)
        values = [
            trajectory.slip_speed[SCENARIO.control_start_step],
            found.torsion_speed_std_rpm,
            found.acceleration_std_m_s2,
        ]
        for cell, value in zip(cells, values, strict=True):
            assert_printed(cell, value)


def test_the_weight_that_we_take_has_the_lowest_std_of_the_acceleration():
    rows = [row for row in table('weight') if row[0] != 'static law']
    assert float(min(rows, key=lambda row: float(row[4]))[0]) == TORQUE_RATE_WEIGHT


@pytest.mark.parametrize('row', table('controllers'), ids=lambda row: row[0])
def test_the_table_of_controllers(row):
    name, *cells = row
    values = []
    for architecture in ('base', 'feedforward', 'feedforward_tanh'):
        trajectory = run_headless(RunSettings(SCENARIO, architecture), name)
        error = trajectory.slip_reference[:, 0] - trajectory.slip_speed
        values += [np.abs(error).max(), metrics(trajectory).torsion_speed_std_rpm]
    for cell, value in zip(cells, values, strict=True):
        assert_printed(cell, value)


def test_the_response_to_a_step_of_engine_torque():
    text = PAGE.read_text(encoding='utf-8')
    at_once, finally_, exact_at_once = re.search(
        r'request by\s([\d.]+) N m at once and by the static ([\d.]+) N m\s'
        r'in the end \(ρ → 0: ([\d.]+) N m',
        text,
    ).groups()
    assert_printed(at_once, design_feedforward(DRIVELINE).d[0, 0])
    assert_printed(finally_, constant_slip_torque(DRIVELINE, 1.0, 0.0))
    assert_printed(exact_at_once, design_feedforward(DRIVELINE, NEARLY_EXACT).d[0, 0])
