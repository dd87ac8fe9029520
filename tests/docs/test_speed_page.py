# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page on speed shows the history of `make bench`, with the names that the bench declares."""

import re
from pathlib import Path

import pytest
from bench.comparisons import ALL
from bench.skeleton.comparison import Bench, Comparison, Point
from bench.skeleton.history import HISTORY as WRITTEN
from bench.skeleton.history import append, record_of
from bench.skeleton.machine import Machine
from bench.skeleton.rounds import Result, measure
from bench.skeleton.workspace import ROOT, Workspace
from generator.pages import DOCS, as_markdown, shown_tables
from generator.speed.speed_charts import DRAWN_FROM, PANELS, PICTURE, speed_figure
from generator.speed.speed_history import HISTORY, digest_of, histories, speed_tables
from PIL import Image

AGAIN = 'run: make docs KINDS=speed'
PAGE = (DOCS / 'develop' / 'speed.md').read_text(encoding='utf-8')
MACHINE = Machine('Processor X', 2, '3.11', {'numpy': '2.4.0'})
OTHER = Machine('Processor Y', 8, '3.11', {'numpy': '2.4.0'})


@pytest.fixture
def history(tmp_path: Path) -> Path:
    """Return the history of two machines, the first of which measured the chain twice."""
    for ratio in (9.0, 1.0):
        results = [
            Result(f'chain, nodes {nodes}', 'the chain', (ratio, nodes * ratio, 20.0),
                   point=Point('nodes', nodes))
            for nodes in (12, 4)
        ]  # fmt: skip
        append(record_of(results, MACHINE, 3, '', 0.1), MACHINE, tmp_path)
    results = [
        Result('graph', 'the chain', (1.4, 1.2, 1.3), 1.5),
        Result('update', 'DAQP', (6.0, 5.0, 7.0)),
        Result('page', 'a bare page', reason='no browser'),
    ]
    append(record_of(results, OTHER, 3, '', 0.1), OTHER, tmp_path)
    return tmp_path


def test_the_tables_have_the_newest_figures_of_each_machine(history: Path) -> None:
    tables = speed_tables(histories(history))
    assert [row[:2] for row in tables['machines'].rows] == [
        ['A', 'Processor X'], ['B', 'Processor Y'],
    ]  # fmt: skip
    assert tables['bounded'].rows == [
        ['graph', 'the chain', '1.5', '-', '1.3 (1.2 to 1.4)'],
    ]
    assert tables['reported'].rows == [['update', 'DAQP', '-', '6 (5 to 7)']]


def test_a_curve_has_its_newest_points_in_the_order_of_the_abscissa(history: Path) -> None:
    first, second = histories(history)
    assert first.curve('nodes') == {'chain': [(4, 4.0, 1.0, 20.0), (12, 12.0, 1.0, 20.0)]}
    assert second.curve('nodes') == {}


def test_a_panel_draws_medians_and_spreads(history: Path) -> None:
    panel, *_ = speed_figure(histories(history)).axes
    (container,) = panel.containers
    line, _, (bars,) = container.lines  # type: ignore[attr-defined]
    assert line.get_xydata().tolist() == [[4, 4], [12, 12]]
    assert [segment[:, 1].tolist() for segment in bars.get_segments()] == [[1, 20], [1, 20]]


def test_the_page_shows_the_history_of_the_bench() -> None:
    assert HISTORY == WRITTEN
    assert shown_tables('speed') == as_markdown(speed_tables(histories())), AGAIN
    with Image.open(PICTURE) as image:
        assert image.info[DRAWN_FROM] == digest_of(), AGAIN
    assert f'](../images/{PICTURE.name})' in PAGE


def test_each_panel_has_a_curve_of_the_bench_and_of_the_history() -> None:
    declared = {each.point.abscissa for each in ALL if each.point}
    assert declared == set(PANELS)
    for abscissa in PANELS:
        assert any(machine.curve(abscissa) for machine in histories()), abscissa


def test_the_page_states_the_bounds_of_the_bench() -> None:
    bounds = {f'{bound:.3g}' for each in ALL for bound in each.bounds.values()}
    stated = PAGE.partition('## The bounds')[2].partition('\n## ')[0]
    assert set(re.findall(r'\| ([0-9.]+) \|$', stated, re.MULTILINE)) == bounds


def test_the_figure_that_the_page_adds_is_measured() -> None:
    (example,) = re.findall(r'```python\n(.*?)```', PAGE, re.DOTALL)
    names: dict[str, object] = {}
    exec(example, names)
    (added,) = [value for value in names.values() if isinstance(value, Comparison)]
    (result,) = measure(added, Bench(Workspace(ROOT)), 1)
    assert (result.name, result.bound) == ('step of lqi', 2.0)
    assert result.median > 0.0
