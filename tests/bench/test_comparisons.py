# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The comparisons of `make bench`: their bounds, their outcomes without a piece, the program."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from bench.__main__ import choose
from bench.comparisons import ALL
from bench.comparisons.graph import CHAIN
from bench.comparisons.start_up import WARM_PARENT
from bench.peers.numpy_loop import numpy_loop_s
from bench.skeleton.comparison import Bench, Comparison
from bench.skeleton.rounds import NOT_MEASURED, measure
from bench.skeleton.workspace import ROOT, Workspace

BENCH = Bench(Workspace(ROOT))


def _found(name: str, reference: str = '') -> Comparison:
    (found,) = [each for each in ALL if each.name == name and reference in each.reference]
    return found


def test_each_comparison_is_declared_once_and_states_its_cost() -> None:
    pairs = [(each.name, each.reference) for each in ALL]
    assert len(set(pairs)) == len(pairs)
    assert all(each.meaning.endswith('.') for each in ALL)


def test_the_bounds_are_those_of_the_project() -> None:
    assert _found('graph: one process per node, step', CHAIN).bound_of('') == 1.5
    assert _found('graph: one process, step', CHAIN).bound_of('') == 1.9
    plates = _found('sticking plates')
    assert plates.bounds == {
        'median of controllers': 1.5,
        'costliest of controllers and scenarios': 3.0,
    }
    assert _found('headless step of a shift').bound_of('') == 1.6
    assert _found('headless step of PI', 'blocks').bound_of('') == pytest.approx(1 / 3)
    assert _found('campaign on two Dask workers').bound_of('') == pytest.approx(1 / 1.6)
    start_up = _found('start-up of the graph')
    assert start_up.bound_of('one run, to its first tick') == pytest.approx(1 / 3)
    assert start_up.bound_of('a further run, processor time') is None
    assert _found('suite: make test').bound_of('') == 0.8


def test_the_tests_of_two_versions_run_only_where_they_are_named() -> None:
    names = {each.name for each in choose(ALL, [])}
    assert not any(name.startswith('suite') for name in names)
    assert [each.name for each in choose(ALL, ['suite'])] == [
        'suite: make test', 'suite: make test-fast',
    ]  # fmt: skip


@pytest.mark.parametrize(
    ('name', 'reference', 'reason'),
    [
        ('report of 5 runs, drawn', '', 'there is no Chromium on this machine'),
        ('mpc3 as C, update', '', 'there is no C compiler cc'),
        ('start-up of the graph', '', 'no base commit: make bench BASE=REV'),
        ('mpc_preview, update', 'do-mpc', 'do_mpc is not installed'),
        ('H-infinity synthesis', '', 'slycot is not installed'),
        ('headless step of PI', 'blocks', 'control is not installed'),
        ('QP of 4 moves, 8 hard rows', 'cvxpy', 'cvxpy is not installed'),
    ],
)
def test_a_missing_piece_is_not_measured(
    name: str, reference: str, reason: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('PATH', '')
    for package in ('do_mpc', 'slycot', 'control', 'cvxpy'):
        monkeypatch.setitem(sys.modules, package, None)
    (result,) = measure(_found(name, reference), BENCH, 1)
    assert result.outcome == NOT_MEASURED
    assert result.reason.startswith(reason)


def _with_make(folder: Path, test: str) -> Workspace:
    """Return a workspace whose tests are the command `test`."""
    folder.mkdir()
    (folder / 'Makefile').write_text(f'.PHONY: fmu test\nfmu:\ntest:\n\t@{test}\n')
    return Workspace(folder)


def test_the_bound_of_the_tests_applies_only_beside_a_base_without_the_warm_parent(
    tmp_path: Path,
) -> None:
    assert (ROOT / WARM_PARENT).exists()
    bench = Bench(_with_make(tmp_path / 'ours', ':'), _with_make(tmp_path / 'base', 'sleep 0.2'))
    (result,) = measure(_found('suite: make test'), bench, 2)
    assert (result.bound, result.outcome) == (0.8, 'met')
    warm_parent = tmp_path / 'base' / WARM_PARENT
    warm_parent.parent.mkdir(parents=True)
    warm_parent.touch()
    (result,) = measure(_found('suite: make test'), bench, 1)
    assert (result.bound, len(result.ratios)) == (None, 1)


def test_the_time_of_tests_that_fail_is_no_figure(tmp_path: Path) -> None:
    bench = Bench(_with_make(tmp_path / 'ours', ':'), _with_make(tmp_path / 'base', 'false'))
    (result,) = measure(_found('suite: make test'), bench, 1)
    assert result.outcome == 'FAILED'
    assert result.reason.startswith('ProgramError: make test ended with code 2')


def test_a_batch_of_numpy_runs_costs_less_than_as_many_loops() -> None:
    assert numpy_loop_s(300) < 0.2 * 300 * numpy_loop_s()


def _bench(*options: str) -> subprocess.CompletedProcess[str]:
    path = os.pathsep.join([str(ROOT / 'tests'), os.environ.get('PYTHONPATH', '')])
    return subprocess.run(
        [sys.executable, '-P', '-m', 'bench', *options],
        env={**os.environ, 'PYTHONPATH': path},
        capture_output=True,
        text=True,
        check=False,
    )


def test_the_program_prints_ratios_and_keeps_three_rounds_or_more(tmp_path: Path) -> None:
    history = tmp_path / 'speed'
    record = tmp_path / 'record.json'
    figure = 'QP of 4 moves, 8 hard rows'
    for rounds in ('2', '3'):
        done = _bench(figure, '--rounds', rounds, '--history', str(history), '--json', str(record))
        assert done.returncode == 0, done.stderr
        assert history.exists() == (rounds == '3')
    assert done.stdout.startswith('Beside DAQP bare  ')
    assert max(map(len, done.stdout.splitlines())) <= 80
    (file,) = history.glob('*.jsonl')
    kept = json.loads(file.read_text())
    assert kept == json.loads(record.read_text())
    assert {figure['name'] for figure in kept['figures']} == {
        'QP of 4 moves, 8 hard rows: median',
        'QP of 4 moves, 8 hard rows: p99',
    }
    # Ours adds scaling and checks to the bare solver, cvxpy far more to its solver.
    ratios = {figure['reference']: figure['ratio'] for figure in kept['figures'][::2]}
    assert ratios['cvxpy'] < 0.2 < 1.0 < ratios['DAQP bare']


def test_a_word_that_no_figure_has_and_no_number_of_rounds_are_one_line() -> None:
    done = _bench('nonsense')
    assert (done.returncode, done.stdout) == (1, '')
    assert done.stderr == 'bench: no figure has nonsense in its name: see --list\n'
    done = _bench('--rounds', '0')
    assert done.returncode == 2
    assert "'0' is no number of rounds: give 1 or more" in done.stderr
