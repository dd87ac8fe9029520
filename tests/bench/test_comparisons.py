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
from bench.comparisons.suite import passed_in
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
    assert _found('least_jerk in upshift, update').bound_of('median') == 2
    assert _found('campaign on two Dask workers').bound_of('') == pytest.approx(1 / 1.6)
    start_up = _found('start-up of the graph')
    assert start_up.bound_of('one run, to its first tick') == pytest.approx(1 / 3)
    assert start_up.bound_of('a further run, processor time') is None
    assert _found('suite: make test').bound_of('tests that both pass') == 0.8


def test_the_tests_of_two_versions_run_only_where_they_are_named() -> None:
    names = {each.name for each in choose(ALL, [])}
    assert not any(name.startswith('suite') for name in names)
    assert [each.name for each in choose(ALL, ['suite'])] == [
        'suite: make test', 'suite: make test-fast',
    ]  # fmt: skip
    (alone,) = choose(ALL, ['suite: make test'])
    assert alone.name == 'suite: make test'


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


def _with_tests(folder: Path, **tests: str) -> Workspace:
    """Return a workspace whose `make test` runs one file with these tests, by their names."""
    folder.mkdir()
    lines = [f'def test_{name}():\n    {body}\n' for name, body in tests.items()]
    (folder / 'test_all.py').write_text('import time\n' + '\n'.join(lines))
    (folder / 'pytest.ini').write_text('[pytest]\n')
    command = f'{sys.executable} -m pytest -q -p no:cacheprovider test_all.py'
    (folder / 'Makefile').write_text(f'.PHONY: test\ntest:\n\t@{command}\n')
    return Workspace(folder)


def test_the_tests_that_both_versions_pass_are_compared(tmp_path: Path) -> None:
    quick, slow = 'time.sleep(0.01)', 'time.sleep(0.5)'
    ours = _with_tests(tmp_path / 'ours', both=quick, broken=slow, new=slow)
    base = _with_tests(tmp_path / 'base', both=slow, broken='raise ValueError', gone=slow)
    bench = Bench(ours, base)
    shared, whole = measure(_found('suite: make test'), bench, 1)
    assert (shared.name, shared.bound, shared.outcome) == (
        'suite: make test: tests that both pass', 0.8, 'met',
    )  # fmt: skip
    assert shared.median < 0.5 < 0.8 < whole.median
    assert whole.bound is None


def test_the_bound_of_the_tests_applies_only_beside_a_base_without_the_warm_parent(
    tmp_path: Path,
) -> None:
    assert (ROOT / WARM_PARENT).exists()
    base = _with_tests(tmp_path / 'base', one='time.sleep(0.01)')
    warm_parent = base.folder / WARM_PARENT
    warm_parent.parent.mkdir(parents=True)
    warm_parent.touch()
    bench = Bench(_with_tests(tmp_path / 'ours', one='pass'), base)
    shared, _ = measure(_found('suite: make test'), bench, 1)
    assert (shared.bound, len(shared.ratios)) == (None, 1)


@pytest.mark.parametrize(
    ('ours', 'base', 'outcome', 'reason'),
    [
        ({'one': 'raise ValueError'}, {'one': 'pass'}, 'FAILED', 'ProgramError: make test ended'),
        ({'one': 'pass'}, {'other': 'pass'}, NOT_MEASURED, 'no test that both versions pass'),
    ],
)
def test_tests_that_fail_or_that_only_one_version_has_give_no_figure(
    tmp_path: Path, ours: dict[str, str], base: dict[str, str], outcome: str, reason: str
) -> None:
    sides = _with_tests(tmp_path / 'ours', **ours), _with_tests(tmp_path / 'base', **base)
    (result,) = measure(_found('suite: make test'), Bench(*sides), 1)
    assert result.outcome == outcome
    assert result.reason.startswith(reason)


def test_the_tests_of_a_session_of_colcon_have_the_names_of_one_session(tmp_path: Path) -> None:
    """An older version runs those of a package so, and their names begin with the package."""
    of_a_package = 'testcase classname="ddct_plant.ddct_plant.test.test_clutch" time="0.5"'
    cases = f"""\
<testsuites><testsuite>
<{of_a_package} name="test_a"/>
<{of_a_package} name="test_b"><failure/></testcase>
<{of_a_package} name="test_c"><skipped/></testcase>
</testsuite></testsuites>
"""
    result = tmp_path / 'ddct_plant' / 'pytest.xml'
    result.parent.mkdir()
    result.write_text(cases)
    assert dict(passed_in(result)) == {'ddct_plant.test.test_clutch::test_a': 0.5}


def test_a_base_that_cannot_run_its_tests_has_none_that_both_pass(tmp_path: Path) -> None:
    base = _with_tests(tmp_path / 'base', one='pass')
    (base.folder / 'Makefile').write_text('test:\n\t@false\n')
    bench = Bench(_with_tests(tmp_path / 'ours', one='pass'), base)
    (result,) = measure(_found('suite: make test'), bench, 1)
    assert result.outcome == NOT_MEASURED


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
