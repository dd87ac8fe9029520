# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Run several plans into one folder, with scores, margins and the report beside their bags."""

from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path

from ddct_bringup.api.shell.pages import REPORT_FILE, draw_page, drawn_apart, write_report
from ddct_bringup.bag.recording import Recording
from ddct_bringup.manifest.manifest import finish_manifest
from ddct_bringup.manifest.runs import begin_comparison
from ddct_bringup.report.evidence import FREQUENCY_FILE
from ddct_bringup.report.run_labels import in_order
from ddct_bringup.run.description import custom_data
from ddct_bringup.run.output_folder import StagedFolder, locked_folders, mark_folder
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.run.timing_and_failure import note_failure
from ddct_bringup.scores.document import scores_document
from ddct_bringup.scores.floors import with_floors
from ddct_bringup.scores.scored_recording import ScoredRecording, run_and_score, score_any_bag
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.validity import realtime_summary
from ddct_bringup.verdict.limits import Limits
from ddct_controllers.workflows.evidence import frequency_evidence
from ddct_controllers.workflows.evidence_types import FrequencyEvidence, linear_entries
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import write_json

SCORES_FILE = 'scores.json'
FILES = (SCORES_FILE, FREQUENCY_FILE, REPORT_FILE)
"""Files beside the bags of a comparison."""


class NoValidRunError(DdctError):
    """No run of a comparison is valid, so its folder keeps its partial name."""


@dataclass(frozen=True)
class Comparer:
    """How the runs of a comparison are carried out and followed."""

    execute: Callable[[RunPlan, Path, str], Recording | None]
    """Execute a plan into a folder; the text says which of the runs it is."""
    complain: Callable[[str], None]
    """Take a line on a failed run, on one in real time, or on a controller without margins."""
    show: Callable[[Sequence[ScoredRun]], None]
    """Take the scores of all runs as soon as they are there, also if none is valid."""


def compare_into(
    plans: Sequence[RunPlan],
    out: Path,
    limits: Limits,
    comparer: Comparer,
    *,
    overwrite: bool,
    floors: bool,
) -> tuple[list[ScoredRun], list[DdctError]]:
    """
    Execute plans with the same settings and commit `out` with their bags and `FILES`.

    Return the scores, and the errors of controllers that have no margins. The reason of a failed
    run goes into its folder. Raise NoValidRunError when no run is valid: `out` stays as it was.
    """
    unusable: list[DdctError] = []
    # A graph has the processor for itself.
    headless = all(plan.layout == 'headless' for plan in plans)
    drawing = drawn_apart() if headless else nullcontext(draw_page)
    with (
        locked_folders(out),
        StagedFolder(out, overwrite=overwrite) as folder,
        drawing as draw,
    ):
        chosen = [plan.controller for plan in plans]
        named = {plan.name: plan for plan in plans}
        begin_comparison(folder.path, named, limits, floors=floors)
        evidence = frequency_evidence(chosen, plans[0].settings, unusable.append)
        runs = [
            _run(plan, folder.path, f'{index} of {len(plans)}, ', limits, comparer)
            for index, plan in enumerate(plans, start=1)
        ]
        if floors:
            runs = with_floors(runs, limits)
        scored = [run.scores for run in runs]
        write_json(str(folder.path / SCORES_FILE), scores_document(scored, limits))
        comparer.show(scored)
        if not any(run.valid for run in scored):
            names = ', '.join(plan.name for plan in plans)
            raise NoValidRunError(f'no run is valid ({names}): {folder.left}')
        write_json(str(folder.path / FREQUENCY_FILE), evidence)
        _say_unstable(evidence, comparer)
        write_report(in_order(runs), str(folder.path / REPORT_FILE), limits, draw)
        finish_manifest(folder.path)
        folder.commit()
    return scored, unusable


def _say_unstable(evidence: FrequencyEvidence, comparer: Comparer) -> None:
    """Name the linear controllers whose loop is unstable with the car of the runs."""
    entries = linear_entries(evidence)
    names = [each.controller for each in entries if not each.nominal.margins.stable]
    if names:
        comparer.complain(
            f'unstable with this car and a new clutch that slips: {", ".join(names)}; the report '
            f'and {FREQUENCY_FILE} have all margins'
        )


def _run(
    plan: RunPlan, out: Path, label: str, limits: Limits, comparer: Comparer
) -> ScoredRecording:
    """
    Execute and score one run; write the reason of a failed one into its folder.

    Raise DdctError when that folder cannot be written, as on a full disk: other runs would fail
    too.
    """
    bag = out / plan.name
    mark_folder(bag)

    def execute(plan: RunPlan, folder: Path) -> Recording | None:
        return comparer.execute(plan, folder, label)

    try:
        scored = run_and_score(plan, bag, limits, execute)
        if scored.recording and not scored.recording.facts.lockstep:
            comparer.complain(f'{plan.name}: {realtime_summary(scored.recording)}')
        return scored
    except DdctError as error:
        reason = str(error)
    reason = reason.replace(f'{bag}/', '')  # the folder gets its final name later
    comparer.complain(f'{plan.name}: {reason}')
    note_failure(bag, reason, custom_data(plan.settings, plan.name, plan.steps))
    return score_any_bag(bag, out, limits)
