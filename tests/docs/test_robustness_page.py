# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The maps of docs/thesis/robustness_map.md are what its campaigns give, and so is the page."""

import re
from itertools import product

import numpy as np
import pytest
from generator.pages import DOCS, as_markdown, shown_tables
from generator.robustness.robustness_charts import DRAWN_FROM, LABELS, pictures, robustness_figure
from generator.robustness.robustness_map import LETTERS, RECORD, SPECS, StateMap, kept_maps
from generator.robustness.robustness_tables import NOMINAL_DELAY_S, ranges_text, robustness_tables
from PIL import Image

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.rows import scored_headless
from ddct_bringup.reproduction.values.orders import WORN
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import ENGAGED, INVALID, NOT_ENGAGED, RUNAWAY

AGAIN = 'run: python docs/robustness.py DELAY MASS, after the campaigns that the page shows'
PAGE = (DOCS / 'thesis' / 'robustness_map.md').read_text(encoding='utf-8')
STRIDE = 97
"""Between the runs that are made again: no multiple of a line, so that all wear gains occur."""


@pytest.fixture(scope='module')
def maps() -> dict[str, StateMap]:
    return kept_maps()


@pytest.mark.parametrize('name', SPECS)
def test_runs_of_the_map_end_in_the_state_of_the_map(name: str, maps: dict[str, StateMap]) -> None:
    found = maps[name]
    campaign = Campaign(found.spec)
    kept = found.states.ravel().tolist()
    assert len(kept) == campaign.runs
    for index in range(0, campaign.runs, STRIDE):
        run = campaign.run(index)
        scores = scored_headless(run.settings, run.controller, packaged_limits())
        assert scores.verdict.state == kept[index], f'run {index}, {run.varied}: {AGAIN}'


def test_the_tables_are_those_of_the_maps(maps: dict[str, StateMap]) -> None:
    assert shown_tables('robustness') == as_markdown(robustness_tables(maps)), AGAIN


def test_each_figure_is_drawn_from_its_map_and_is_on_the_page(
    maps: dict[str, StateMap],
) -> None:
    for picture, (name, _) in pictures(maps).items():
        with Image.open(picture) as image:
            assert image.info[DRAWN_FROM] == maps[name].digest, f'{picture.name}: {AGAIN}'
        assert f'](../images/{picture.name})' in PAGE


def test_a_figure_has_the_plane_of_each_controller_and_plant(maps: dict[str, StateMap]) -> None:
    found = maps['mass']
    figure = robustness_figure(found, 'detailed', *LABELS['mass'])
    shown = [axes.collections[0].get_array() for axes in figure.axes]
    numbers = {state: place for place, state in enumerate(LETTERS)}
    planes = [
        [[numbers[state] for state in line] for line in found.plane(name, 'detailed', clutch)]
        for clutch, name in product(found.values('clutch'), found.spec.controllers)
    ]
    assert [array.tolist() for array in shown] == planes


def test_only_hinf2_is_engaged_at_both_wear_gains_of_table_5_2(maps: dict[str, StateMap]) -> None:
    found = maps['delay']
    wears = found.values('wear_gain')
    for architecture in found.values('architecture'):
        lines = {
            name: found.line(name, architecture, 'linear', NOMINAL_DELAY_S)
            for name in found.spec.controllers
        }
        at_both = [
            name
            for name, line in lines.items()
            if {line[wears.index(worn)] for worn in WORN} == {ENGAGED}
        ]
        assert at_both == ['hinf2']


def test_only_mpc4_on_the_linear_plant_has_runs_that_diverge(maps: dict[str, StateMap]) -> None:
    diverged = maps['delay'].states == INVALID
    places = {tuple(place) for place in np.argwhere(diverged)[:, [0, 2]].tolist()}
    found = maps['delay']
    mpc4, linear = found.spec.controllers.index('mpc4'), found.values('clutch').index('linear')
    assert places == {(mpc4, linear)}


def test_ranges_are_written_by_their_ends_and_gaps_part_them() -> None:
    gains = (0.7, 0.8, 0.9, 1.0, 1.1)
    assert ranges_text(gains, [NOT_ENGAGED, ENGAGED, ENGAGED, ENGAGED, RUNAWAY]) == '0.8 to 1'
    assert ranges_text(gains, [ENGAGED, RUNAWAY, ENGAGED, ENGAGED, ENGAGED]) == '0.7, 0.9 to 1.1'
    assert ranges_text(gains, [RUNAWAY] * 5) == '-'


def test_the_page_names_the_specifications_and_the_record() -> None:
    named = set(re.findall(r'examples/(robustness_\w+\.yaml)', PAGE))
    assert named == {path.name for path in SPECS.values()}
    assert RECORD.name in PAGE
