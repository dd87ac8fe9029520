# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A tuning gives the same front for any workers, after a kill, and to its repetition."""

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pyarrow as pa
import pytest
from refusals import refused
from samples import sampled
from small_tuning import campaign_of, leave_out_pictures, tuning

from ddct_bringup.api import run
from ddct_bringup.evaluation.quantities import MAIN
from ddct_bringup.many_runs.local_workers import ThisProcess
from ddct_bringup.programs.tune import main
from ddct_bringup.tuning import conduct, evaluation, study
from ddct_bringup.tuning.conduct import carry_out_tuning
from ddct_bringup.tuning.evaluation import TrialRuns
from ddct_bringup.tuning.report.folder import write_tuning
from ddct_bringup.tuning.result import ParameterRange, TuningResult
from ddct_bringup.tuning.specification.spec import TuningSpec
from ddct_bringup.tuning.study import JOURNAL, TuningStudy, read_trials
from ddct_bringup.tuning.tables import RUNS, TRIALS, rows_by_trial
from ddct_bringup.tuning.trial import DOMINATED, FEASIBLE, INFEASIBLE, Trial
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.json_records import json_text, read_json
from ddct_plant.scenario.file import load_scenario, scenario_to_yaml

pytestmark = pytest.mark.slow

SAME = ('front.json', TRIALS, RUNS, 'best.yaml', 'held_out/results.parquet')


@pytest.fixture(autouse=True)
def no_pictures_and_small_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    leave_out_pictures(monkeypatch)
    monkeypatch.setattr(evaluation, 'LEAST_TOGETHER', 1)  # so that trials end early


def bytes_of(folder: Path) -> list[bytes]:
    return [(folder / name).read_bytes() for name in SAME]


def written(tuned: Any, out: Path, **options: Any) -> Path:
    write_tuning(out, carry_out_tuning(tuned, out, **options), workers=1)
    return out


def test_another_seed_searches_elsewhere(finished: Path, tmp_path: Path) -> None:
    other = tuning(seed=4, trials=2)
    trials = carry_out_tuning(other, tmp_path / 'out', workers=1)
    known = read_trials(finished)
    assert trials[0].values == known[0].values  # those from before
    assert trials[1].values != known[1].values


@pytest.mark.parametrize('place', sampled(['rows', 'trial', 'trials'], every=3))
def test_a_killed_tuning_goes_on_to_the_same_bytes_with_any_number_of_workers(
    finished: Path, tmp_path: Path, place: str
) -> None:
    """`finished` has two workers, and this one has one."""
    out, calls = tmp_path / 'out', []

    def killed(study: TuningStudy, trials: Sequence[Trial]) -> None:
        calls.append(trials)
        if len(calls) == 2:
            if place == 'rows':  # the rows are there, their trials are not
                (out / 'shards' / '000001.parquet').write_bytes(b'half of a file')
            if place == 'trial':
                real(study, trials[:1])
                with (out / JOURNAL).open('a') as journal:
                    journal.write('{"op_code": 4, "wor')
            if place == 'trials':
                real(study, trials)
            raise KeyboardInterrupt
        real(study, trials)

    real = TuningStudy.add
    with pytest.MonkeyPatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr(conduct.TuningStudy, 'add', killed)
        carry_out_tuning(tuning(), out, workers=1)
    assert bytes_of(written(tuning(), out, workers=1, resume=True)) == bytes_of(finished)


def test_a_folder_with_a_tuning_needs_resume_and_the_same_tuning(tmp_path: Path) -> None:
    out = tmp_path / 'out'
    with refused(DdctError, place=str(out)):
        carry_out_tuning(tuning(), out, resume=True)
    carry_out_tuning(tuning(trials=1), out, workers=1)
    with refused(DdctError, key='--resume'):
        carry_out_tuning(tuning(trials=1), out)
    with refused(DdctError, key='spec'):
        carry_out_tuning(tuning(trials=2), out, resume=True)


def test_altered_or_deleted_rows_are_computed_again_and_an_altered_study_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / 'out'
    first = carry_out_tuning(tuning(trials=2), out, workers=1)
    path = out / 'shards' / '000000.parquet'
    rows = path.read_bytes()
    path.write_bytes(rows[:-1])
    again = carry_out_tuning(tuning(trials=2), out, workers=1, resume=True)
    assert [each.state for each in again] == [each.state for each in first]
    assert f'ddct tune: {path}: altered' in capsys.readouterr().err
    assert path.read_bytes() == rows
    path.unlink()
    carry_out_tuning(tuning(trials=2), out, workers=1, resume=True)
    assert path.read_bytes() == rows
    journal = out / JOURNAL
    recorded = journal.read_text()
    for pattern, other in (
        ('"integral_gain":0.0223[0-9]*', '"integral_gain":0.5'),
        ('"value(s?)":(\\[?)[0-9.]+', '"value\\1":\\g<2>0.25'),
    ):
        altered = re.sub(pattern, other, recorded)
        assert altered != recorded
        journal.write_text(altered)
        with refused(DdctError, key='--out'):
            carry_out_tuning(tuning(trials=2), out, workers=1, resume=True)


def test_the_result_is_read_as_its_record_and_written_as_it_was(finished: Path) -> None:
    file = finished / 'front.json'
    assert json_text(read_json(TuningResult, file)) == file.read_text(encoding='utf-8')


def test_no_trial_of_the_front_ends_early(finished: Path) -> None:
    trials = trials_of(finished)
    tuned = tuning()
    ended = [each for each in trials[1:] if len(each.rows) < len(tuned.cases)]
    assert ended and FEASIBLE not in {each.state for each in ended}
    alone = TrialRuns.by(tuned, ThisProcess())
    whole = [_whole(tuned, alone, each) if each in ended else each for each in trials]
    assert front_of(tuned.spec, trials) == front_of(tuned.spec, whole)


def trials_of(folder: Path) -> list[Trial]:
    """Return the trials of a finished tuning with their runs."""
    rows = rows_by_trial(folder / RUNS)
    return [replace(each, rows=rows.get(each.number, each.rows)) for each in read_trials(folder)]


def front_of(spec: TuningSpec, trials: Sequence[Trial]) -> dict[int, tuple[float, ...]]:
    """Return the costs of the trials on the front by their numbers."""
    study = TuningStudy(spec, {})
    study.add(trials)
    chosen = [trials[number] for number in study.front()]
    return {each.number: each.costs(spec, len(each.rows)) for each in chosen}


def test_a_trial_that_another_betters_whatever_comes_ends_after_the_first_part() -> None:
    tuned = tuning(constraints={'engaged': {'at_least': 0.0}})
    names = [goal.name for goal in tuned.spec.objectives]
    row = {'state': 'engaged', **dict.fromkeys(names, 1e-6)}
    rows = pa.Table.from_pylist([row] * len(tuned.cases))
    rival = Trial(90, {}, rows)
    asked = {
        0: {'proportional_gain': 0.2, 'integral_gain': 0.5},
        1: {'proportional_gain': 0.2, 'integral_gain': 0.5},
    }
    alone = TrialRuns.by(tuned, ThisProcess())
    present, other = alone.batch(asked, [rival], lambda trial: trial)
    assert (other.state, len(other.rows)) == (DOMINATED, 1)
    assert len(present.rows) == len(tuned.cases)
    infeasible = Trial(91, {}, rows, state=INFEASIBLE)
    _, free = alone.batch(asked, [infeasible], lambda trial: trial)
    assert len(free.rows) == len(tuned.cases)


def test_a_part_has_many_runs_where_a_batch_computes_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(evaluation, 'LEAST_TOGETHER', 3)
    tuned = tuning(constraints={'engaged': {'at_least': 1.0}})  # 5 cases: 1, 2 and 5 else
    slow = {1: {'proportional_gain': 0.05, 'integral_gain': 0.01}}
    alone = TrialRuns.by(tuned, ThisProcess())
    assert alone.together
    (ended,) = alone.batch(slow, [], lambda trial: trial)
    assert (ended.state, len(ended.rows)) == (INFEASIBLE, 5)


def test_only_a_trial_that_keeps_all_else_is_timed_and_a_long_time_makes_it_infeasible() -> None:
    tuned = tuning(
        constraints={'engaged': {'at_least': 0.9}, 'update_time_over_pi': {'at_most': 2.0}}
    )
    times = {0: 3.0, 1: 1.0, 2: 1.0}
    quick, slow = (
        {'proportional_gain': 0.2, 'integral_gain': 0.5},
        {'proportional_gain': 0.05, 'integral_gain': 0.01},
    )
    trials = TrialRuns.by(tuned, ThisProcess()).batch(
        {0: quick, 1: quick, 2: slow},
        [],
        lambda trial: replace(trial, further={'update_time_over_pi': times[trial.number]}),
    )
    assert [each.state for each in trials] == [INFEASIBLE, FEASIBLE, INFEASIBLE]
    assert [len(each.further) for each in trials] == [1, 1, 0]
    assert 'update time' in trials[0].reason and 'engaged' in trials[2].reason


def _whole(tuned: Any, alone: TrialRuns, trial: Trial) -> Trial:
    """Return a trial with all of its runs."""
    rows = alone.rows([(trial.values, case) for case in tuned.cases])
    return Trial(trial.number, trial.values, rows, {}, FEASIBLE).checked(
        tuned.spec, len(tuned.cases)
    )


def test_the_file_of_the_best_gives_the_runs_of_the_trial(finished: Path) -> None:
    result = json.loads((finished / 'front.json').read_text())
    row = trials_of(finished)[result['best']].rows.to_pylist()[0]
    again = run(str(finished / 'best.yaml'), wear_gain=row['wear_gain'])
    for name in ('peak_jerk_m_s3', 'torsion_speed_std_rpm'):
        assert again.metrics[name] == pytest.approx(row[name], rel=1e-9)


@pytest.mark.nightly
def test_the_seed_of_held_out_cases_follows_from_the_tuned_files(
    finished: Path, tmp_path: Path
) -> None:
    other = written(tuning(trials=12, seed=6), tmp_path / 'other', workers=1)
    seeds = {
        json.loads((out / 'front.json').read_text())['held_out_seed'] for out in (finished, other)
    }
    assert len(seeds) == 2 and tuning().campaign.spec.root not in seeds


def test_the_result_shows_development_beside_held_out(finished: Path) -> None:
    result: Mapping[str, Any] = json.loads((finished / 'front.json').read_text())
    best = next(each for each in result['front'] if each['number'] == result['best'])
    ours, theirs = best['development']['objectives'], best['held_out']['objectives']
    assert ours.keys() == theirs.keys() and ours != theirs
    assert [each['name'] for each in result['gaps']] == list(MAIN)
    without = {each['name'] for each in result['gaps'] if each['p_value'] is None}
    assert without == {'response_s', 'releases'}  # a linear clutch has no lock
    assert result['before']['parameters'] == {'proportional_gain': 0.103, 'integral_gain': 0.0223}
    assert result['before']['development']['engaged']['of'] == result['cases']
    assert sum(result['states'].values()) == result['trials'] == 20
    assert result['runs'] < result['all_runs']


def test_a_value_at_an_end_of_its_range_is_named() -> None:
    assert ParameterRange(0.0, 0.3, 'linear').end_near(0.299) == 'its highest, 0.3'
    assert ParameterRange(0.01, 1.0, 'log').end_near(0.0102) == 'its lowest, 0.01'
    assert ParameterRange(0.01, 1.0, 'log').end_near(0.02) == ''


def test_constraints_that_no_trial_keeps_end_with_a_line(tmp_path: Path) -> None:
    tight = tuning(
        trials=3,
        constraints={'engaged': {'at_least': 0.2}, 'peak_jerk_m_s3': {'at_most': 1e-6}},
    )
    out = tmp_path / 'out'
    with refused(DdctError) as caught:
        written(tight, out, workers=1)
    assert 'peak jerk at most 1e-06' in str(caught.value)
    assert (out / TRIALS).exists() and not (out / 'best.yaml').exists()


def test_the_numbers_of_a_transfer_function_are_tuned_and_its_result_is_tuned_again(
    tmp_path: Path,
) -> None:
    file = tmp_path / 'mine.yaml'
    form = 'polynomial: {num: [-0.035, -0.8, -1.1], den: [1, 8, 0]}'
    file.write_text(f'name: mine\nunits: {{input: rpm, output: N m}}\n{form}\n')
    changes = {
        'parameters': {'num_0': {'low': -0.05, 'high': -0.02}},
        'constraints': {'engaged': {'at_least': 0.0}},
        'objectives': {'torsion_speed_std_rpm': {}},
        'trials': 3,
    }
    out = written(tuning(str(file), **changes), tmp_path / 'out', workers=1)
    best = json.loads((out / 'front.json').read_text())
    assert best['before']['parameters'] == {'num_0': -0.035}
    further = tuning(str(out / 'best.yaml'), **changes)
    again = written(further, tmp_path / 'again', workers=1)
    before = json.loads((again / 'front.json').read_text())['before']['parameters']
    assert before == best['front'][0]['parameters']


FAILING = """
from ddct_controllers.interface import Controller
from ddct_plant.base.options import Option


class Failing(Controller):
    options = {'gain': Option(0.1, 'gain')}

    def reset(self):
        pass

    def update(self, measurement):
        raise ZeroDivisionError('it fell over')
"""


def test_a_controller_that_always_fails_ends_with_its_reason(tmp_path: Path) -> None:
    file = tmp_path / 'failing.py'
    file.write_text(FAILING)
    parameters = {'gain': {'low': 0.0, 'high': 1.0}}
    with refused(DdctError) as caught:
        failing = tuning(str(file), parameters=parameters, trials=100, campaign=campaign_of(1))
        carry_out_tuning(failing, tmp_path / 'out', workers=1)
    assert 'it fell over' in str(caught.value) and '16 trials' in str(caught.value)


def test_without_optuna_a_line_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def missing(name: str) -> str:
        raise study.importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(study.importlib.metadata, 'version', missing)
    assert main(['--controller', 'pi', '--spec', 'pi_launches', '--out', str(tmp_path / 'o')]) == 1
    complaint = capsys.readouterr().err
    assert 'make setup EXTRAS=tune' in complaint and complaint.count('\n') == 1


def test_options_that_scenarios_give_differently_must_be_tuned(tmp_path: Path) -> None:
    file = tmp_path / 'other.yaml'
    changed = load_scenario('thesis', ['controllers.pi.integral_gain=0.5'])
    file.write_text(scenario_to_yaml(changed))
    made = tuning(
        folder=tmp_path,
        parameters={'proportional_gain': {'low': 0.1, 'high': 0.2}},
        campaign={'grid': {'scenario': ['thesis', 'other.yaml']}},
    )
    with refused(ParameterError, key='parameters.integral_gain'):
        carry_out_tuning(made, tmp_path / 'out')
