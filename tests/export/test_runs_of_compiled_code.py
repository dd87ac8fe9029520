# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Each run of a controller in C has fresh static variables, and ends itself alone."""

import json
import os
import shutil
from pathlib import Path
from typing import Any

import pytest
from refusals import refused
from support.c_controllers import ENDS, counting, harmful
from support.exported_mpc import run_settings

from ddct_bringup import api
from ddct_bringup.bag.reader import read_bag
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.scored import are_together
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.programs.compare import main as compare
from ddct_bringup.programs.verify import main as verify
from ddct_bringup.run import headless
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_controllers.check import subject
from ddct_controllers.check.checks import FAIL, PASS, check_controller
from ddct_controllers.interface import Controller
from ddct_controllers.loop import ClosedLoop
from ddct_controllers.registry import controller_spec
from ddct_controllers.workflows.evidence import frequency_evidence
from ddct_controllers.workflows.loop_summary import loop_summary
from ddct_plant.program import own_process
from ddct_plant.program.own_process import ProcessEndedError
from ddct_plant.scenario.settings import KnownSettings

SETTINGS = run_settings('duration_s=0.7')
OPTIONS = {'duration_s': 0.7}


@pytest.fixture(scope='module')
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp('libraries')


@pytest.fixture(scope='module')
def counter(folder: Path) -> str:
    return counting(folder)


@pytest.fixture(scope='module')
def harm(folder: Path) -> str:
    return harmful(folder)


@pytest.fixture(autouse=True)
def soon(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a library that never answers be ended soon."""
    monkeypatch.setattr(own_process, '_MOST_SECONDS', 1)


def torques(run: api.Run) -> list[float]:
    found: list[float] = run.recording.trajectory.closed_loop_torque.tolist()
    return found


def test_runs_one_after_another_count_from_one_again(counter: str) -> None:
    first, again = (api.run(counter, set=OPTIONS) for _ in range(2))
    assert torques(first)[59:62] == [0.0, 0.001, 0.002]
    assert torques(again) == torques(first)
    assert run_headless(SETTINGS, controller_spec(counter)).closed_loop_torque[61] == 0.002


def test_a_loop_is_built_here_first_so_that_not_every_process_does_its_imports(
    counter: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    built: list[int] = []
    build = headless.ClosedLoop

    def noted(*given: Any, **options: Any) -> ClosedLoop:
        built.append(os.getpid())
        return build(*given, **options)

    monkeypatch.setattr(headless, 'ClosedLoop', noted)
    run_headless(SETTINGS, counter)
    assert built == [os.getpid()]


def test_the_update_times_of_a_run_come_out_of_its_process(counter: str) -> None:
    timing = RunTiming()
    run_headless(SETTINGS, counter, timing)
    assert (timing.steps, len(timing.update_times_us)) == (SETTINGS.scenario.steps, 71)
    assert min(timing.update_times_us) > 0.0


@pytest.mark.nightly
def test_two_of_a_comparison_count_from_one(counter: str, folder: Path, tmp_path: Path) -> None:
    other = folder / 'other.yaml'
    other.write_text(Path(counter).read_text().replace('name: counting', 'name: other'))
    given = ['--controllers', f'{counter},{other}', '--headless', '--floors', 'none']
    out = tmp_path / 'out'
    assert compare([*given, '--duration', '0.7', '--out', str(out)]) == 0
    first, again = (
        read_bag(out / name).trajectory.closed_loop_torque for name in ('counting', 'other')
    )
    assert first[61] == again[61] == 0.002


@pytest.mark.slow
@pytest.mark.nightly
def test_the_rows_of_a_campaign_are_equal_with_one_worker_and_two(
    counter: str, tmp_path: Path
) -> None:
    spec = {'controllers': [counter], 'grid': {'duration_s': [0.7], 'seed': [1, 2, 3, 4]}}
    rows = []
    for workers in (1, 2):
        out = tmp_path / str(workers)
        found = api.campaign(spec, out, workers=workers).table
        rows.append((out / 'results.parquet').read_bytes())
        same = found.drop(columns='seed').drop_duplicates()
        assert (len(found), len(same)) == (4, 1)
    assert rows[0] == rows[1]


@pytest.mark.slow
def test_what_ends_a_run_of_a_campaign_is_the_reason_in_its_row(harm: str, tmp_path: Path) -> None:
    faults = [0, *ENDS]
    spec = {
        'controllers': ['pi', harm],
        'grid': {
            'duration_s': [0.7],
            'controllers.harmful.fault': [*map(float, faults)],
        },
    }
    found = api.campaign(spec, tmp_path / 'out', workers=2).table
    mine = found[found.controller == 'harmful']
    assert found.valid.tolist() == 5 * [True] + [True] + 4 * [False]
    place = 'controller file harmful.yaml: line 2: c_library.file: '
    for fault, reason in zip(faults, mine.reason, strict=True):
        if fault:
            assert reason.startswith(place)
            assert reason.endswith(
                f'.so: {ENDS[fault]} when update was called at step 65: mend it'
            )


@pytest.mark.usefixtures('no_page')
def test_a_crash_in_a_comparison_is_the_reason_of_its_run(
    harm: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    given = ['--controllers', f'{harm},pi', '--headless', '--floors', 'none', '--duration', '0.7']
    out = tmp_path / 'out'
    assert compare([*given, '--set', 'controllers.harmful.fault=3', '--out', str(out)]) == 1
    mine, pi = json.loads((out / 'scores.json').read_text())['runs']
    assert (mine['valid'], pi['valid']) == (False, True)
    assert f'{ENDS[3]} when update was called at step 65' in mine['reason']
    lines = [line for line in capfd.readouterr().err.splitlines() if 'harmful' in line]
    assert len([line for line in lines if 'SIGSEGV' in line]) == 1


@pytest.mark.usefixtures('no_page')
def test_a_crash_while_it_is_loaded_does_not_end_a_comparison(
    harm: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr('ddct_controllers.from_file.c_library.library.Library.reset', _abort)
    given = ['--controllers', f'{harm},pi', '--headless', '--floors', 'none', '--duration', '0.7']
    out = tmp_path / 'out'
    assert compare([*given, '--out', str(out)]) == 1
    mine, pi = json.loads((out / 'scores.json').read_text())['runs']
    assert (mine['valid'], pi['valid']) == (False, True)
    assert f'{ENDS[2]} when reset was called: mend it' in mine['reason']


def _abort(_: object) -> None:
    os.abort()


@pytest.mark.slow
def test_the_rows_of_a_sweep_have_the_reasons(harm: str) -> None:
    over = {'controllers.harmful.fault': [0.0, 1.0, 2.0]}
    found = api.sweep([harm], over, duration=0.7)
    assert found.valid.tolist() == [True, False, False]
    assert [each.partition(': it ')[2][:5] for each in found.reason] == ['', 'ended', 'crash']


def test_a_crash_fails_the_checks_in_which_it_happens(harm: str, counter: str) -> None:
    faulty = run_settings('controllers.harmful.fault=3')
    found = {each.name: each for each in check_controller(harm, faulty.known)}
    assert [found[name].state for name in ('constructor', 'options', 'prints')] == 3 * [PASS]
    assert found['answers'].state == FAIL
    assert f'{ENDS[3]} when update was called at step 65: mend it' in found['answers'].detail


@pytest.mark.nightly
def test_checks_share_the_trials_that_each_of_them_needs(
    counter: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made, trial = tmp_path / 'trials', subject.closed_trial

    def noted(settings: KnownSettings, controller: Controller) -> subject.ClosedLoopLog:
        with made.open('a', encoding='utf-8') as file:
            file.write(f'{type(controller).__name__}\n')
        return trial(settings, controller)

    monkeypatch.setattr(subject, 'closed_trial', noted)
    check_controller(counter, run_settings().known)
    assert sorted(made.read_text().split()) == ['CLibraryController', 'PiController']


def test_static_variables_are_no_shared_state_but_must_be_reset(counter: str) -> None:
    found = {each.name: each for each in check_controller(counter, run_settings().known)}
    assert [found[name].state for name in ('state', 'determinism')] == 2 * [PASS]
    assert found['reset'].state == FAIL


def test_no_program_loads_the_code_beside_its_runs(
    harm: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr('ddct_controllers.from_file.c_library.controller.Library', _abort)
    (entry,) = frequency_evidence([harm], SETTINGS).controllers
    assert entry.linear is False
    assert loop_summary(harm, SETTINGS) == []
    RunPlan(SETTINGS, harm, 'headless')
    spec = {'controllers': [harm], 'grid': {'duration_s': [0.7]}}
    assert not are_together(Campaign(spec_of(spec, Path())))
    (reason,) = api.campaign(spec, tmp_path / 'out', workers=1).table.reason
    assert reason.endswith(f'{ENDS[2]} when it was loaded: mend it')


def test_another_controller_with_its_options_is_compiled_code_too(
    harm: str, tmp_path: Path
) -> None:
    file = tmp_path / 'tuned.yaml'
    options = f'{{controller: {harm}, options: {{fault: 3.0}}}}'
    file.write_text(f'name: tuned\nwith_options: {options}\n', encoding='utf-8')
    with refused(ProcessEndedError, 'c_library.file', place=f'{harm}: line 2') as raised:
        run_headless(SETTINGS, str(file))
    assert f'{ENDS[3]} when update was called at step 65' in str(raised.value)


@pytest.mark.nightly
def test_a_result_carries_the_library_and_comes_out_again(tmp_path: Path) -> None:
    place, out = tmp_path / 'place', tmp_path / 'runs'
    place.mkdir()
    file = Path(counting(place))
    given = ['--controllers', f'{file},pi', '--duration', '0.7', '--headless', '--out', str(out)]
    assert compare(given) == 0
    shutil.rmtree(place)
    moved = out.rename(tmp_path / 'moved')
    assert verify([str(moved)]) == 0
