# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The program `report`: the numbers on its page, and its errors for bad input."""

import json
import re
import shutil
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path

import pytest
from drawn_charts import leave_out_time_charts
from page_reader import PageReader
from support.runs import plan, record

from ddct_bringup.bag.reader import mcap_of
from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.programs import compare
from ddct_bringup.programs.report import main
from ddct_bringup.programs.score import main as score
from ddct_bringup.report.evidence import FREQUENCY_FILE
from ddct_bringup.verdict.limits import load_limits
from ddct_plant.program.command_line import package_version
from ddct_plant.scenario.settings import KnownSettings, RunSettings

CONTROLLERS = ('pi', 'ls8', 'hinf1')
WITHOUT = ('time_to_final_lock_s', 'releases', 'peak_temperature_degc', 'worst_lateness_us')
"""Metrics that no run in lock-step with a linear clutch has."""
NO_FLOORS = ('--floors', 'none')
"""Options of reports on other subjects; floors take longer than the rest of a page."""


@pytest.fixture
def without_charts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave out the charts over time, which take longer than the texts and tables of a page."""
    leave_out_time_charts(monkeypatch)


def scores_of(folder: Path, capsys: pytest.CaptureFixture[str]) -> list[dict]:
    score([str(folder), '--json', '-'])
    return json.loads(capsys.readouterr().out)['runs']


def read(page: Path) -> PageReader:
    return PageReader(page.read_text(encoding='utf-8'))


def test_the_page_has_every_figure_and_metric_of_scores_json_to_the_last_bit(
    demo: Path, page: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    runs = {run['controller']: run for run in scores_of(demo, capsys)}
    metrics = [{**runs[name]['figures'], **runs[name]['metrics']} for name in CONTROLLERS]
    assert [each.pop('least_is_bound') for each in metrics] == [True] * len(CONTROLLERS)
    shown: dict[str, list[float | None]] = {}
    for name, value, _ in read(page).metrics:
        shown.setdefault(name, []).append(value)
    assert shown == {name: [each[name] for each in metrics] for name in metrics[0]}
    assert {name for name, values in shown.items() if None not in values} >= {
        'peak_jerk_over_least',
        'friction_work_j',
        'engagement_time_s',
        'update_time_median_us',
    }
    assert not shown.keys() & {metric.key for metric in METRICS.values() if metric.of_shift}


def test_the_text_shows_the_rounded_numbers_and_the_thesis_s(page: Path) -> None:
    reader = read(page)
    for name, value, text in reader.metrics:
        if value is None:
            assert (name in WITHOUT, text) == (True, '–')
            continue
        decimals = len(text.partition('.')[2])
        assert float(text.replace('−', '-')) == pytest.approx(value, abs=0.51 * 10.0**-decimals)
    for printed in ('0.88', '0.71', '0.79', '1.15', '0.87', 'calibrated'):
        assert printed in reader.text


@pytest.mark.usefixtures('without_charts')
def test_a_predicted_value_is_a_hit_or_a_miss(tmp_path: Path) -> None:
    record(plan('mpc3', 'headless', duration_s=3.0), tmp_path / 'mpc3')
    out = tmp_path / 'report.html'
    assert main([str(tmp_path), *NO_FLOORS, '--out', str(out)]) == 0
    text = read(out).text
    assert 'predicted' in text
    assert 'miss' in text
    assert 'a hit is within 25 % of the print' in text


@pytest.mark.usefixtures('without_charts')
def test_the_page_judges_by_the_limits_that_are_given(demo: Path, tmp_path: Path) -> None:
    mine, out = tmp_path / 'mine.yaml', tmp_path / 'report.html'
    text = (files('ddct_bringup.verdict') / 'limits.yaml').read_text(encoding='utf-8')
    rules = text[: text.index('limits:')]
    limit = '- {metric: friction_work_j, value: 7, unit: J, applies_to: all, convention: true'
    mine.write_text(f'{rules}limits:\n{limit}, reason: as agreed}}\n', encoding='utf-8')
    assert main([str(demo / 'pi'), *NO_FLOORS, '--limits', str(mine), '--out', str(out)]) == 0
    shown = read(out).text
    assert re.search(r'\blimit\s*7 convention', shown)
    assert 'as agreed' in shown
    assert f'Judged by the limits mine.yaml {load_limits(mine).origin["digest"]}' in shown
    assert 'convention' in shown
    assert '▲ beyond its limit' in shown
    assert 'ISO 2631-1:1997' not in shown


def test_bad_limits_are_named_before_anything_is_read(tmp_path: Path, capsys) -> None:
    assert main([str(tmp_path), '--limits', str(tmp_path / 'none.yaml')]) == 1
    assert capsys.readouterr().err.startswith(
        f'ddct report: limits {tmp_path / "none.yaml"}: cannot'
    )


@pytest.mark.usefixtures('without_charts')
def test_the_header_lists_the_changes_of_the_packaged_scenario(page: Path, tmp_path: Path) -> None:
    record(plan('pi', 'headless', duration_s=1.0), tmp_path / 'pi')
    out = tmp_path / 'report.html'
    assert main([str(tmp_path), *NO_FLOORS, '--out', str(out)]) == 0
    text = out.read_text(encoding='utf-8')
    changed = 'thesis, 1 value changed: duration_s=1.0'
    assert f'Scenario <b>{changed}</b>' in text
    assert f'<title>Clutch engagement, {changed}: pi</title>' in text
    assert 'Scenario <b>thesis</b>' in page.read_text(encoding='utf-8')


def test_the_page_has_its_origin(page: Path) -> None:
    text = read(page).text
    for told in (
        'thesis',
        package_version(),
        'halfshaft_stiffness: 6716.3112',
        'detailed',
        'lockstep',
    ):
        assert told in text
    assert 'gains.proportional_gain = 0.103' in text


def test_nothing_on_the_page_comes_from_elsewhere(page: Path) -> None:
    reader = read(page)
    assert {link for link in reader.links if not link.startswith('#')} == {'data:,'}
    assert 'url(' not in reader.styles
    assert '@import' not in reader.styles


def test_a_damaged_bag_is_marked_and_the_others_stay(
    demo: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    runs = tmp_path / 'demo'
    shutil.copytree(demo, runs)
    file = mcap_of(runs / 'ls8')
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 1
    file.write_bytes(content)
    out = tmp_path / 'report.html'
    assert main([str(runs), *NO_FLOORS, '--out', str(out)]) == 1
    error = capsys.readouterr().err
    assert error.startswith('ddct report: ls8: ')
    assert 'the recording is damaged' in error
    reader = read(out)
    assert '1 of 3 runs is invalid' in reader.text
    assert 'the recording is damaged' in reader.text
    engagement = [value for name, value, _ in reader.metrics if name == 'engagement_time_s']
    assert [value is None for value in engagement] == [False, True, False]


def test_a_run_that_ended_early_is_marked(demo: Path, tmp_path: Path) -> None:
    from ddct_bringup.bag.trajectory_bag import write_trajectory
    from ddct_bringup.run.description import custom_data
    from ddct_bringup.run.headless import run_headless

    whole, short = plan('pi', 'headless', duration_s=3.0), plan('pi', 'headless', duration_s=1.0)
    write_trajectory(
        run_headless(short.settings, 'pi'),
        tmp_path / 'pi',
        'pi',
        custom_data(whole.settings, 'pi', whole.steps),
        {'load': {'version': '0.1.0'}},
    )
    out = tmp_path / 'report.html'
    assert main([str(tmp_path / 'pi'), str(demo / 'ls8'), *NO_FLOORS, '--out', str(out)]) == 1
    assert 'ended early: 100 of 300 steps' in read(out).text


def test_runs_of_several_scenarios_are_refused_and_named(
    demo: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    steep = plan('pi', 'headless', duration_s=3.0, changes=('load.slope_rad=0.05',))
    record(steep, tmp_path / 'steep')
    out = tmp_path / 'report.html'
    assert main([str(demo), str(tmp_path / 'steep'), '--out', str(out)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith('ddct report: the runs are of 2 scenarios')
    assert 'steep' in line
    assert 'ls8' in line
    assert not out.exists()


@pytest.mark.usefixtures('without_charts')
def test_labels_distinguish_wear_gains_and_architectures_of_one_scenario(
    demo: Path, tmp_path: Path
) -> None:
    worn = plan('ls8', 'headless', duration_s=3.0, wear_gain=0.7)
    record(worn, tmp_path / 'worn')
    other = plan('ls8', 'headless', duration_s=3.0)
    settings = RunSettings(KnownSettings(other.settings.scenario, 'feedforward'))
    record(type(other)(settings, 'ls8', 'headless'), tmp_path / 'other')
    out = tmp_path / 'report.html'
    bags = [str(folder) for folder in (demo / 'ls8', tmp_path / 'worn', tmp_path / 'other')]
    assert main([*bags, *NO_FLOORS, '--out', str(out)]) == 0
    text = read(out).text
    for label in ('ls8, detailed, wear 1', 'ls8, detailed, wear 0.7', 'ls8, feedforward, wear 1'):
        assert label in text


@pytest.mark.usefixtures('without_charts')
def test_the_same_bag_named_twice_is_one_run(demo: Path, tmp_path: Path) -> None:
    out = tmp_path / 'report.html'
    assert (
        main([str(demo / 'pi'), str(mcap_of(demo / 'pi').parent), *NO_FLOORS, '--out', str(out)])
        == 0
    )
    assert '1 run' in read(out).text


def page_with(evidence: dict, demo: Path, folder: Path) -> str:
    """Return the text of a page over the run of PI, with this evidence beside its bag."""
    shutil.copytree(demo / 'pi', folder / 'pi')
    (folder / FREQUENCY_FILE).write_text(json.dumps(evidence), encoding='utf-8')
    out = folder / 'report.html'
    assert main([str(folder / 'pi'), *NO_FLOORS, '--out', str(out)]) == 0
    return read(out).text


def of_another_scenario(evidence: dict) -> None:
    evidence['conditions']['scenario_digest'] = 'another'


def at_another_wear_gain(evidence: dict) -> None:
    for point in evidence['controllers'][0]['wear']:
        point['wear_gain'] += 0.05


@pytest.fixture
def marked_evidence(demo: Path) -> dict:
    """Return the evidence of the runs, with a wrong gain margin of PI as a mark."""
    evidence = json.loads((demo / FREQUENCY_FILE).read_text(encoding='utf-8'))
    assert evidence['controllers'][0]['controller'] == 'pi'
    for point in evidence['controllers'][0]['wear']:
        point['gain_margin_db'] = 87.6
    return evidence


@pytest.mark.usefixtures('without_charts')
def test_evidence_beside_the_bags_is_taken(
    demo: Path, marked_evidence: dict, tmp_path: Path
) -> None:
    text = page_with(marked_evidence, demo, tmp_path)
    assert re.search(r'pi\s*1\s*yes\s*87\.6\s*75\.6', text)
    assert 'Computed for this page' not in text


@pytest.mark.usefixtures('without_charts')
@pytest.mark.parametrize('change', [of_another_scenario, at_another_wear_gain])
def test_evidence_of_another_loop_is_not_taken(
    demo: Path, marked_evidence: dict, tmp_path: Path, change: Callable[[dict], None]
) -> None:
    change(marked_evidence)
    text = page_with(marked_evidence, demo, tmp_path)
    assert re.search(r'pi\s*1\s*yes\s*9\.7\s*75\.6', text)
    assert 'Computed for this page' in text


@pytest.mark.parametrize(
    ('out', 'says'),
    [
        ('missing/report.html', 'there is no folder'),
        ('notes.txt', 'is a file that is not ours'),
        ('.', 'is a folder'),
    ],
)
def test_a_page_that_cannot_be_written_is_refused_before_work(
    out: str, says: str, demo: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / 'notes.txt').write_text('mine', encoding='utf-8')
    assert main([str(demo), '--out', str(tmp_path / out)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert says in line
    assert (tmp_path / 'notes.txt').read_text(encoding='utf-8') == 'mine'


@pytest.mark.usefixtures('without_charts')
def test_an_earlier_page_of_ours_is_replaced(demo: Path, page: Path, tmp_path: Path) -> None:
    out = tmp_path / 'report.html'
    shutil.copy(page, out)
    assert main([str(demo / 'pi'), *NO_FLOORS, '--out', str(out)]) == 0
    assert 'hinf1' not in read(out).text


def test_no_runs_or_no_readable_one_is_an_error(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main([])
    assert ended.value.code == 2
    out = tmp_path / 'report.html'
    (tmp_path / 'empty').mkdir()
    assert main([str(tmp_path / 'empty'), '--out', str(out)]) == 1
    assert 'no .mcap file in this folder or below it' in capsys.readouterr().err
    (tmp_path / 'empty' / 'pi.mcap').write_bytes(b'')
    assert main([str(tmp_path / 'empty'), '--out', str(out)]) == 1
    assert 'none of the 1 bags can be read' in capsys.readouterr().err
    assert not out.exists()


def test_without_the_chart_library_the_program_names_the_package_to_install(
    demo: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr('importlib.util.find_spec', lambda name: None)
    assert main([str(demo)]) == 1
    assert capsys.readouterr().err == (
        'ddct report: the report needs the Python package bokeh: pip install bokeh\n'
    )


@pytest.mark.usefixtures('without_charts')
def test_the_page_goes_to_standard_output_on_request(
    demo: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([str(demo / 'pi'), *NO_FLOORS, '--out', '-']) == 0
    assert capsys.readouterr().out.startswith('<!DOCTYPE html>')


@pytest.mark.usefixtures('without_charts')
def test_a_controller_that_fell_back_is_named(tmp_path, capsys):
    """The scores of such a run are not those of the controller's own program."""
    changes = ['controllers.mpc3.iteration_limit=1', 'controllers.mpc3.highest_torque_n_m=300']
    options = [part for change in changes for part in ('--set', change)]
    folder = tmp_path / 'runs'
    options += [*NO_FLOORS, '--headless', '--out', str(folder)]
    assert compare.main(['--controllers', 'mpc3', *options]) == 0
    fallbacks = json.loads((folder / 'scores.json').read_text())['runs'][0]['fallbacks']
    assert fallbacks > 0
    note = f'at {fallbacks} of 300 steps its program had no solution'
    assert note in capsys.readouterr().out
    assert note in (folder / 'report.html').read_text()
