# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The report of a log shows the measured signals, and simulated runs in the same charts."""

import json
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from support.other_car import COLUMNS, drive, write_csv
from support.runs import plan, record

from ddct_bringup.programs import report, score
from ddct_bringup.scores.csv_text import signals_csv

pytestmark = pytest.mark.slow

MAP = """\
columns:
  time: {column: time_s, unit: s}
  engine_speed: {column: engine_speed_rad_s, unit: rad/s}
  shaft_speed: {column: primary_shaft_speed_rad_s, unit: rad/s}
  clutch_torque: {column: primary_shaft_effort_n_m, unit: N m}
run: {controller: pi, scenario: thesis, control_start_s: 0.6, score_window_s: [0.6, 1.7]}
"""


@pytest.fixture(scope='module')
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a log of another car, one of a run of ours, and that run."""
    place = tmp_path_factory.mktemp('logs')
    run = '  vehicle_accel: {column: ax, unit: g}\nrun: {control_start_s: 0.5}\n'
    (place / 'other.yaml').write_text(COLUMNS + run)
    write_csv(place / 'other.csv', 3, drive(1))
    recording = record(plan('pi', 'headless', duration_s=2.0), place / 'runs' / 'pi')
    (place / 'drive.csv').write_text(signals_csv(recording))
    (place / 'map.yaml').write_text(MAP)
    return place


def page_of(place: Path, *runs: str, columns: str = 'map.yaml') -> str:
    out = place / 'page.html'
    given = [str(place / each) for each in runs] + ['--floors', 'none']
    assert report.main([*given, '--columns', str(place / columns), '--out', str(out)]) == 0
    return out.read_text(encoding='utf-8')


@pytest.fixture(scope='module')
def page_of_other_car(folder: Path) -> str:
    return page_of(folder, 'other.csv', columns='other.yaml')


def visible(page: str) -> str:
    """Return the text of a page, without scripts and marks."""
    bare = re.sub(r'<(script|style)\b.*?</\1>', '', page, flags=re.DOTALL)
    return ' '.join(re.sub(r'<[^>]*>', ' ', bare).split())


def lines(page: str) -> Iterator[tuple[str, str, np.ndarray]]:
    """Yield chart, name and values of each line that is drawn."""
    from bokeh.document import Document
    from bokeh.models import ColumnDataSource

    (data,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', page)
    for chart in Document.from_json(json.loads(data)['document']).roots:
        for each in chart.renderers:  # type: ignore[attr-defined]
            if each.glyph.__class__.__name__ == 'Line':
                source = each.data_source
                assert isinstance(source, ColumnDataSource)
                yield (
                    chart.name or '',
                    each.name or '',
                    np.asarray(source.data[each.glyph.y.field]),
                )


def test_every_chart_of_a_log_has_a_line_and_the_measured_torques_are_among_them(
    page_of_other_car: str,
) -> None:
    page = page_of_other_car
    drawn = {chart: values for chart, name, values in lines(page) if name}
    titles = re.findall(r'id="chart-(\w+)"', page)
    assert set(titles) == set(drawn) == {'w_d', 'A_x', 'C_m', 'w_m', 'C_f_transmitted'}
    for chart, values in drawn.items():
        assert np.isfinite(values).all(), chart
    wanted = drive(1).clutch_torque
    assert drawn['C_f_transmitted'][0] == pytest.approx(wanted[0], abs=0.01)
    assert np.ptp(drawn['C_f_transmitted']) == pytest.approx(np.ptp(wanted), rel=0.01)


def test_the_reasons_on_the_page_of_a_log_are_those_of_a_log(page_of_other_car: str) -> None:
    text = visible(page_of_other_car)
    before, _, _ = text.partition('Definitions Reading the tables')
    for reason in (
        'a log has no phases of the plates',
        'a log has no temperature of the facing',
        'w sr needs the column wheel_speed and run.total_ratio',
        'a log does not tell the loop that was closed there',
        'a log has no update times',
        '1 log of a car',
    ):
        assert reason in before, reason
    for of_a_run in (
        'the clutch is linear',
        'timing.json',
        'the bag',
        'unknown',
        'wear 1',
        'seed 0',
    ):
        assert of_a_run not in before.replace('from timing.json: it belongs', ''), of_a_run
    assert 'schema_version' not in before


def test_a_log_and_a_run_lie_over_each_other(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = page_of(folder, 'drive.csv', 'runs')
    by_chart: dict[str, dict[str, np.ndarray]] = {}
    for chart, name, values in lines(page):
        by_chart.setdefault(chart, {})[name] = values
    for chart in ('w_d', 'w_m', 'C_f_transmitted'):
        both = by_chart[chart]
        assert {'pi', 'pi, measured'} <= set(both)
        np.testing.assert_allclose(both['pi, measured'], both['pi'], atol=1e-3)
    assert set(by_chart['C_f_request']) == {'pi'}
    text = visible(page)
    assert ' · detailed · wear 1 · lockstep · seed 0 · 1 log of a car' in text
    assert 'The runs come from' not in text
    assert 'Not all runs have the same times' not in text
    assert 'duration_s: 2.0' in text, 'the scenario is that of the simulated run'
    assert (
        score.main(
            [str(folder / each) for each in ('drive.csv', 'runs')]
            + ['--columns', str(folder / 'map.yaml')]
        )
        == 0
    )
    table = capsys.readouterr().out
    rows = [line for line in table.splitlines() if line.rstrip().endswith('engaged')]
    figures = [re.findall(r' (\d\.\d{3}) ', row)[0] for row in rows]
    assert len(figures) == 2 and figures[0] == figures[1]


@pytest.mark.nightly
def test_other_times_of_a_log_are_named_at_the_top(folder: Path) -> None:
    (folder / 'late.yaml').write_text(MAP.replace('control_start_s: 0.6', 'control_start_s: 0.7'))
    text = visible(page_of(folder, 'drive.csv', 'runs', columns='late.yaml'))
    assert 'Not all runs have the same times' in text
    assert 'pi, measured : score window 0.6 to 1.7 s, control from 0.7 s' in text


@pytest.mark.process
def test_a_log_of_another_name_is_refused_with_the_key_that_lays_it_over_them(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / 'named.yaml').write_text(MAP.replace('scenario: thesis', 'scenario: hill'))
    given = [str(folder / each) for each in ('drive.csv', 'runs')]
    out = folder / 'refused.html'
    assert report.main([*given, '--columns', str(folder / 'named.yaml'), '--out', str(out)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert 'hill: ' in line and 'write run.scenario in the column map of a log' in line
    assert not out.exists()
