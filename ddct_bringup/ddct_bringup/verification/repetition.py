# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Make a result again in a scratch folder, from the plan and the inputs that it carries."""

import shutil
from collections.abc import Callable, Mapping
from contextlib import nullcontext
from dataclasses import dataclass, field
from pathlib import Path

from ddct_bringup.api.shell.comparison import SCORES_FILE
from ddct_bringup.api.shell.pages import REPORT_FILE, write_report
from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.trajectory_bag import write_trajectory
from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.benchmark.conduct import Options, carry_out_benchmark
from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.benchmark.plan import RecordedBenchmark
from ddct_bringup.benchmark.release import ROWS, release_rows
from ddct_bringup.benchmark.report.folder import write_result
from ddct_bringup.campaign.conduct import carry_out
from ddct_bringup.campaign.plan import RecordedCampaign
from ddct_bringup.campaign_report.folder import PAGE, write_campaign_page
from ddct_bringup.manifest.manifest import BENCHMARK, CAMPAIGN, RUNS, TUNING, Manifest
from ddct_bringup.manifest.origin import CodeOrigin
from ddct_bringup.manifest.runs import ComparisonPlan, PlannedRun, RunsPlan
from ddct_bringup.report.evidence import FREQUENCY_FILE
from ddct_bringup.report.run_labels import in_order
from ddct_bringup.run.description import as_of_commit, custom_data
from ddct_bringup.run.execution import simulate
from ddct_bringup.run.output_folder import mark_folder
from ddct_bringup.run.plan import RunPlan, require_headless
from ddct_bringup.run.timing_and_failure import TIMING_FILE, failed_run, note_failure
from ddct_bringup.scores.document import scores_document
from ddct_bringup.scores.floors import with_floors
from ddct_bringup.scores.scored_recording import score_any_bag
from ddct_bringup.tuning.conduct import carry_out_tuning
from ddct_bringup.tuning.plan import RecordedTuning
from ddct_bringup.tuning.report.folder import write_tuning
from ddct_bringup.tuning.specification.goals import UPDATE_TIME
from ddct_bringup.tuning.study import read_trials
from ddct_bringup.tuning.trial import FEASIBLE
from ddct_bringup.verification.comparison import Comparison
from ddct_controllers.workflows.evidence import frequency_evidence
from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError, without_folders
from ddct_plant.files.json_records import from_json, to_json, write_json
from ddct_plant.scenario.recorded_settings import RecordedSettings
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.signals.gain_changes import changes_note

REAL_TIME = 'real time'
"""Reason why a run is not repeated."""
_OBJECT = 'a controller that was an object of a Python program'

_FAILED = 'it fails again for the same reason; its bag until then is not made again'


@dataclass
class Repeated:
    """What was not as planned when a result was made again, by the folder of the run."""

    left_out: dict[str, str] = field(default_factory=dict)
    """Reasons why runs cannot be repeated."""
    failed: dict[str, str] = field(default_factory=dict)
    """Reasons why runs could not be repeated, though they should be."""
    notes: dict[str, str] = field(default_factory=dict)
    """What else to know of runs, or of files by their path."""


def repeat(result: Path, manifest: Manifest, scratch: Path, workers: int | None) -> Repeated:
    """
    Make a result again in the folder `scratch`.

    Times on the wall clock, which never come out again, are taken from the result. Raise
    DdctError where it cannot be made.
    """
    same_code = manifest.origin.code == CodeOrigin.here().code
    with as_of_commit(manifest.origin.commit) if same_code else nullcontext():
        return _KINDS[manifest.kind](result, manifest, scratch, workers)


def _repeat_runs(result: Path, manifest: Manifest, scratch: Path, workers: int | None) -> Repeated:
    plan = from_json(RunsPlan, manifest.plan, f'{result}, plan')
    found = Repeated()
    mark_folder(scratch)
    for name, planned in plan.runs.items():
        mark_folder(scratch / name)
        try:
            _repeat_run(result, scratch, name, planned, found)
        except DdctError as error:
            found.failed[name] = str(error)
    if plan.comparison and not found.failed:
        _repeat_comparison(result, scratch, plan.runs, plan.comparison)
    return found


def _repeat_comparison(
    result: Path, scratch: Path, planned: Mapping[str, PlannedRun], plan: ComparisonPlan
) -> None:
    """Make scores, loop analyses and page of repeated runs again."""
    limits = plan.limits.load(result)
    runs = [score_any_bag(scratch / name, scratch, limits) for name in planned]
    if plan.floors:
        runs = with_floors(runs, limits)
    document = scores_document([run.scores for run in runs], limits)
    write_json(str(scratch / SCORES_FILE), document)
    plans = [each.headless_plan(result) for each in planned.values()]
    chosen, settings = [each.controller for each in plans], plans[0].settings
    evidence = frequency_evidence(chosen, settings, report=lambda error: None)
    write_json(str(scratch / FREQUENCY_FILE), evidence)
    write_report(in_order(runs), str(scratch / REPORT_FILE), limits)


def _repeat_run(
    result: Path, scratch: Path, name: str, planned: PlannedRun, found: Repeated
) -> None:
    """Make a run again headless, or copy one that cannot be; raise DdctError where it fails."""
    ours, again = result / name, scratch / name
    settings = planned.run_settings(result)
    if planned.layout == 'headless':
        require_headless(settings)
    lockstep = settings.known.lockstep
    if not lockstep or planned.controller is None:
        found.left_out[name] = _OBJECT if lockstep else REAL_TIME
        if failed_run(ours) is None:
            _require_settings(read_bag(ours), planned.label(result), settings)
        _copy(ours, again)
        return
    if (ours / TIMING_FILE).exists():
        shutil.copy(ours / TIMING_FILE, again)
    plan, failure = planned.headless_plan(result), failed_run(ours)
    recorded = read_bag(ours) if failure is None else None
    changes = recorded.gain_changes if recorded and planned.layout != 'headless' else ()
    found.notes[name] = changes_note(changes)
    try:
        recording, _ = simulate(plan, changes)
    except FOREIGN_FAILURES as error:
        if failure is None:
            raise DdctError(f'its repetition fails: {error}') from error
        if planned.layout != 'headless' and without_folders(str(error)) in failure.reason:
            # There the node's name and its log are around the same reason.
            found.left_out[name] = _FAILED
            _copy(ours, again)
        else:
            _note(plan, again, str(error))
        return
    if failure is not None:
        _note(plan, again, 'its repetition does not fail')
        return
    write_trajectory(
        recording.trajectory, again, plan.name, recording.custom_data, recording.run_info
    )


def _require_settings(recorded: Recording, label: str, settings: RunSettings) -> None:
    """Raise DdctError where a bag that is not repeated has other settings than the plan."""
    if recorded.settings is None:
        raise DdctError('its bag has no settings')
    name, comparison = recorded.facts.controller, Comparison()
    ours, planned = (
        to_json(RecordedSettings.of(each, controller, each.scenario.duration_s))
        for each, controller in ((recorded.settings, name), (settings, label or name))
    )
    comparison.add_nested('settings', ours, planned)
    if first := comparison.bits:
        key, there, given = first.place['key'], first.recorded, first.repeated
        raise DdctError(f'{key}: its bag has {there!r}, its plan {given!r}', key=key)


def _copy(ours: Path, again: Path) -> None:
    """Copy the files of a run that is not repeated, from which scores and page are made."""
    for file in ours.iterdir():
        if file.is_file():
            shutil.copy(file, again)


def _note(plan: RunPlan, folder: Path, reason: str) -> None:
    note_failure(folder, reason, custom_data(plan.settings, plan.name, plan.steps))


def _repeat_campaign(
    result: Path, manifest: Manifest, scratch: Path, workers: int | None
) -> Repeated:
    recorded = RecordedCampaign.read(result)
    carry_out(recorded.campaign(), recorded.limits(), scratch, workers=workers)
    if (result / PAGE).exists():
        write_campaign_page(scratch)
    return Repeated()


def _repeat_benchmark(
    result: Path, manifest: Manifest, scratch: Path, workers: int | None
) -> Repeated:
    recorded = RecordedBenchmark.of(manifest, result)
    plan, code = recorded.plan, recorded.origin.code
    judged = [each.judged(result) for each in plan.controllers]
    options = Options(workers, release=code, rows=result)
    cases = recorded.cases
    if code == CodeOrigin.here().code:
        judged = [Judged.of(each.path) for each in judged]
        options, cases = Options(workers), Cases.packaged(quick=plan.quick, car=cases.car_path)
    failed = carry_out_benchmark(judged, cases, scratch, plan.judge_seed, options)
    shutil.copy(result / TIMING_FILE, scratch)
    write_result(scratch, failed)
    if cases.car is not None:
        return Repeated()
    rows = release_rows(result).origin
    return Repeated(
        notes={ROWS: f'computed by other code: {rows.text}'} if rows.code != code else {}
    )


def _repeat_tuning(
    result: Path, manifest: Manifest, scratch: Path, workers: int | None
) -> Repeated:
    recorded = RecordedTuning.of(manifest, result)
    times = {
        each.number: {UPDATE_TIME: each.further[UPDATE_TIME]}
        for each in read_trials(result)
        if UPDATE_TIME in each.further
    }
    tuning = recorded.tuning(result)
    trials = carry_out_tuning(tuning, scratch, workers=workers, known_times=times)
    try:
        write_tuning(scratch, trials, workers=workers, release=recorded.origin.code)
    except DdctError:
        if any(e.state == FEASIBLE for e in trials):  # else the record is written all the same
            raise
    return Repeated()


_KINDS: Mapping[str, Callable[[Path, Manifest, Path, int | None], Repeated]] = {
    RUNS: _repeat_runs,
    CAMPAIGN: _repeat_campaign,
    BENCHMARK: _repeat_benchmark,
    TUNING: _repeat_tuning,
}
