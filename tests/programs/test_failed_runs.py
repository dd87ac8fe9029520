# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A run that is not valid: `bringup` commits nothing, `compare` the others and its reason."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from support.runs import SHORT_S, plan

from ddct_bringup.programs import bringup, compare, report, score
from ddct_bringup.run import execution
from ddct_bringup.run.plan import RunPlan
from ddct_plant.base.errors import DdctError

Spoil = Callable[[RunPlan, Path], None]
REAL = execution.execute
WHOLE = ['--headless', '--duration', str(SHORT_S)]


def ended_early(run: RunPlan, folder: Path) -> None:
    """Leave a whole bag of half the length that the run should have."""
    from ddct_bringup.bag.trajectory_bag import write_trajectory
    from ddct_bringup.run.description import custom_data
    from ddct_bringup.run.headless import run_headless

    half = plan(run.name, 'headless', duration_s=SHORT_S / 2.0)
    trajectory = run_headless(half.settings, half.controller)
    data = custom_data(run.settings, run.name, run.steps)
    write_trajectory(trajectory, folder, run.name, data, {'load': {'version': '0.1.0'}})


def failed(run: RunPlan, folder: Path) -> None:
    raise DdctError('node clutch was killed by SIGKILL')


def failed_at_the_end(run: RunPlan, folder: Path) -> None:
    REAL(run, folder)
    failed(run, folder)


def interrupted(run: RunPlan, folder: Path) -> None:
    raise KeyboardInterrupt


REASONS: dict[Spoil, str] = {
    ended_early: 'ended early: 50 of 100 steps',
    failed: 'node clutch was killed by SIGKILL',
}


def spoil_ls8(monkeypatch: pytest.MonkeyPatch, spoil: Spoil) -> None:
    """Make every run of LS8 fail, and no other."""

    def execute(run: RunPlan, folder: Path, *rest: Any) -> None:
        if run.name == 'ls8':
            spoil(run, folder)
        else:
            REAL(run, folder, *rest)

    monkeypatch.setattr(execution, 'execute', execute)


@pytest.fixture(params=[ended_early, failed])
def bad_ls8(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Spoil:
    spoil_ls8(monkeypatch, request.param)
    return request.param


def _bytes(folder: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in folder.rglob('*') if path.is_file()}


def test_bringup_keeps_the_old_result_and_prints_the_reason(
    bad_ls8: Spoil, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / 'runs'
    assert bringup.main(['--controller', 'pi', *WHOLE, '--out', str(out)]) == 0
    (out / 'pi').rename(out / 'ls8')
    before = _bytes(out)
    capfd.readouterr()
    options = ['--controller', 'ls8', *WHOLE, '--overwrite', '--out', str(out)]
    assert bringup.main(options) == 1
    printed = capfd.readouterr()
    assert REASONS[bad_ls8] in printed.err
    assert not printed.out
    assert {path: content for path, content in _bytes(out).items() if path in before} == before


def _compare(out: Path, *options: str) -> int:
    return compare.main(['--controllers', 'pi,ls8', *WHOLE, *options, '--out', str(out)])


def _scores(folder: Path) -> list[dict]:
    return json.loads((folder / 'scores.json').read_text())['runs']


def test_compare_keeps_the_valid_runs_and_prints_the_reasons_of_the_others(
    bad_ls8: Spoil, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / 'runs'
    assert bringup.main(['--controller', 'pi', *WHOLE, '--out', str(out)]) == 0
    capfd.readouterr()
    assert _compare(out, '--overwrite') == 1
    reason = REASONS[bad_ls8]
    printed = capfd.readouterr()
    assert 'ddct compare: not valid: ls8: the table and the report say why' in printed.err
    assert 'steps missed' not in printed.err, 'that is of runs in real time'
    rows = {line.split()[0]: line.split()[-1] for line in printed.out.splitlines() if line.split()}
    assert (rows['pi'], rows['ls8']) == ('not_engaged', 'invalid')
    assert f'ls8: not valid: {reason}' in ' '.join(printed.out.split())
    good, bad = _scores(out)
    assert (good['controller'], good['valid'], good['reason']) == ('pi', True, '')
    assert good['metrics']['steps'] == 100
    assert (bad['controller'], bad['bag'], bad['valid']) == ('ls8', 'ls8', False)
    assert bad['reason'] == reason
    assert [run['state'] for run in (good, bad)] == ['not_engaged', 'invalid']
    assert not out.with_name('runs.partial').exists()
    page = (out / 'report.html').read_text()
    assert '1 of 2 runs is invalid' in page
    assert reason in page


def test_report_and_score_print_the_reason_that_compare_printed_of_a_failed_run(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    spoil_ls8(monkeypatch, failed)
    out = tmp_path / 'runs'
    assert _compare(out) == 1
    assert not list((out / 'ls8').glob('*.mcap'))
    _, bad = entries = _scores(out)
    facts = ('scenario', 'architecture', 'wear_gain', 'mode', 'seed')
    assert [bad[name] for name in facts] == ['thesis', 'detailed', 1.0, 'lockstep', 0]
    assert set(bad['metrics'].values()) == {None}
    capfd.readouterr()
    assert score.main([str(out), '--json', '-']) == 1
    printed = capfd.readouterr()
    assert json.loads(printed.out)['runs'] == sorted(entries, key=lambda run: run['bag'])
    assert 'ddct score: node clutch was killed by SIGKILL' in printed.err
    page = tmp_path / 'again.html'
    assert report.main([str(out), '--out', str(page)]) == 1
    assert 'ddct report: ls8: node clutch was killed by SIGKILL' in capfd.readouterr().err
    text = page.read_text()
    assert '1 of 2 runs is invalid' in text
    assert '<b>ls8</b>: node clutch was killed by SIGKILL' in text


def test_a_run_that_failed_after_a_whole_recording_has_no_score(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    spoil_ls8(monkeypatch, failed_at_the_end)
    out = tmp_path / 'runs'
    assert _compare(out) == 1
    assert (out / 'ls8' / 'ls8_0.mcap').is_file()
    _, bad = _scores(out)
    assert (bad['valid'], bad['reason']) == (False, 'node clutch was killed by SIGKILL')
    assert (bad['state'], bad['why'], bad['limits']) == ('invalid', '', [])
    values = {**bad['figures'], **bad['metrics']}
    assert set(values.values()) == {None}
    assert bad['null_reasons'] == {
        **dict.fromkeys(values.keys() - {'least_is_bound'}, 'the run has no scores'),
        'peak_jerk_over_least': bad['reason'],
    }
    page = (out / 'report.html').read_text()
    assert page.count('class="chip"') == 2, 'its signals can be looked at'
    assert page.count('no update times beside this bag') == 1
    again = tmp_path / 'scores.json'
    for bag in (out / 'ls8', out / 'ls8' / 'ls8_0.mcap'):
        assert score.main([str(bag), '--json', str(again)]) == 1
        assert _scores(tmp_path) == [{**bad, 'bag': str(bag)}]


def test_where_no_run_is_valid_an_old_result_stays(
    bad_ls8: Spoil, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / 'runs'
    assert bringup.main(['--controller', 'pi', *WHOLE, '--out', str(out)]) == 0
    before = _bytes(out)
    capfd.readouterr()
    arguments = ['--controllers', 'ls8', *WHOLE, '--overwrite', '--out', str(out)]
    assert compare.main(arguments) == 1
    assert _bytes(out) == before
    partial = out.with_name('runs.partial')
    *_, last = capfd.readouterr().err.splitlines()
    assert last == (
        f'ddct compare: no run is valid (ls8): nothing was written to {out}, '
        f'what was recorded is in {partial}'
    )
    assert [run['valid'] for run in _scores(partial)] == [False]


def test_an_interrupted_compare_keeps_the_old_result_and_names_what_it_recorded(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / 'runs'
    assert bringup.main(['--controller', 'pi', *WHOLE, '--out', str(out)]) == 0
    before = _bytes(out)
    spoil_ls8(monkeypatch, interrupted)
    assert _compare(out, '--overwrite') == 130
    assert _bytes(out) == before
    partial = tmp_path / 'runs.partial'
    assert (partial / 'pi' / 'pi_0.mcap').is_file(), 'it was under way'
    assert capfd.readouterr().err.splitlines()[-1] == (
        f'ddct compare: interrupted: nothing was written to {out}, '
        f'what was recorded is in {partial}'
    )
