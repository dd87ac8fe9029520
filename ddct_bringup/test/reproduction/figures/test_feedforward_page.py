# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""docs/controllers/feedforward.md agrees with the code, to the last printed digit."""

import re

import pytest
from generator.pages import DOCS, as_markdown, shown_tables
from generator.runs.feedforward_tables import DRIVELINE, NEARLY_EXACT, controllers, weights

from ddct_controllers.design.feedforward import TORQUE_RATE_WEIGHT, design_feedforward
from ddct_plant.models.static_torque import constant_slip_torque
from ddct_plant.program.table import Table

pytestmark = pytest.mark.slow

PAGE = DOCS / 'controllers' / 'feedforward.md'


@pytest.fixture(scope='module')
def weight_table() -> Table:
    return weights()


def assert_printed(cell: str, value: float) -> None:
    """Check that a cell is the value at the cell's number of decimals."""
    decimals = len(cell.partition('.')[2])
    assert abs(float(cell) - value) <= 0.501 * 10.0**-decimals, (cell, value)


def test_the_table_of_weights(weight_table):
    """The page has the computed table; after a change run `make docs KINDS=feedforward`."""
    assert shown_tables('feedforward')['weight'] == as_markdown({'weight': weight_table})['weight']


def test_the_weight_that_we_take_has_the_lowest_std_of_the_acceleration(weight_table):
    rows = [row for row in weight_table.rows if row[0] != 'static law']
    assert float(min(rows, key=lambda row: float(row[4]))[0]) == TORQUE_RATE_WEIGHT


def test_the_table_of_controllers():
    """The page has the computed table; after a change run `make docs KINDS=feedforward`."""
    computed = as_markdown({'controllers': controllers()})
    assert shown_tables('feedforward')['controllers'] == computed['controllers']


def test_the_response_to_a_step_of_engine_torque():
    text = ' '.join(PAGE.read_text(encoding='utf-8').split())
    at_once, finally_, exact_at_once = re.search(
        r'request by ([\d.]+) N m at once, and by the static ([\d.]+) N m '
        r'in the end \(ρ → 0: ([\d.]+) N m',
        text,
    ).groups()
    assert_printed(at_once, design_feedforward(DRIVELINE).d[0, 0])
    assert_printed(finally_, constant_slip_torque(DRIVELINE, 1.0, 0.0))
    assert_printed(exact_at_once, design_feedforward(DRIVELINE, NEARLY_EXACT).d[0, 0])
