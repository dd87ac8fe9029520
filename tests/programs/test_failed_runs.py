"""`bringup` and `compare` neither pass nor commit a run that is not valid."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from support.runs import SHORT_S, plan

from ddct_bringup.programs import bringup, compare
from ddct_bringup.run import execution
from ddct_bringup.run.plan import RunPlan
from ddct_plant.base.errors import DdctError

Spoil = Callable[[RunPlan, Path], None]
REAL = execution.execute
WHOLE = ['--headless', '--duration', str(SHORT_S)]


def ended_early(run: RunPlan, folder: Path) -> None:
    """Leave a whole bag of half the length that the run should have."""
    pytest.importorskip('rclpy', reason='rclpy serialises the messages')
    from ddct_bringup.bag.trajectory_bag import write_trajectory
    from ddct_bringup.run.description import custom_data
    from ddct_bringup.run.headless import run_headless

    half = plan(run.controller, 'headless', duration_s=SHORT_S / 2.0)
    trajectory = run_headless(half.settings, half.controller)
    data = custom_data(run.settings, run.name, run.steps)
    write_trajectory(trajectory, folder, run.name, data, {'load': (('version', '0.1.0'),)})


def failed(run: RunPlan, folder: Path) -> None:
    raise DdctError('node clutch was killed by SIGKILL')


@pytest.fixture(params=[ended_early, failed])
def bad_ls8(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Spoil:
    """Let every run of LS8 go wrong, and no other."""

    def execute(run: RunPlan, folder: Path, *rest: Any) -> None:
        if run.name == 'ls8':
            request.param(run, folder)
        else:
            REAL(run, folder, *rest)

    monkeypatch.setattr(execution, 'execute', execute)
    return request.param


def _bytes(folder: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in folder.rglob('*') if path.is_file()}


def test_bringup_keeps_the_old_result_and_says_why(
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
    reason = 'ended early: 50 of 100 steps' if bad_ls8 is ended_early else 'killed by SIGKILL'
    assert reason in printed.err
    assert not printed.out
    assert {path: content for path, content in _bytes(out).items() if path in before} == before


def test_compare_keeps_the_old_result_and_names_the_controller(
    bad_ls8: Spoil, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / 'runs'
    assert bringup.main(['--controller', 'pi', *WHOLE, '--out', str(out)]) == 0
    before = _bytes(out)
    capfd.readouterr()
    options = ['--controllers', 'pi,ls8', *WHOLE, '--overwrite', '--out', str(out)]
    assert compare.main(options) == 1
    assert _bytes(out) == before
    printed = capfd.readouterr()
    assert 'compare: ls8 failed: what was recorded is in' in printed.err
    rows = {line.split()[0]: line.split()[-1] for line in printed.out.splitlines() if line.split()}
    assert (rows['pi'], rows['ls8']) == ('yes', 'NO')
    scores = json.loads((tmp_path / 'runs.partial' / 'scores.json').read_text())['runs']
    assert [(run['controller'], run['valid']) for run in scores] == [('pi', True), ('ls8', False)]
    assert [run['verdict']['state'] for run in scores] == ['not_engaged', 'invalid']
