# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Readers of what stands beside bags: times, failures, digests, scores and loop analyses."""

import io
from collections.abc import Mapping
from contextlib import redirect_stdout
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

from ddct_bringup.api.shell.comparison import SCORES_FILE
from ddct_bringup.manifest.inputs import InputFiles
from ddct_bringup.manifest.limits import NamedLimits
from ddct_bringup.manifest.manifest import ITSELF, MANIFEST, RUNS, begin_manifest, read_manifest
from ddct_bringup.manifest.runs import ComparisonPlan, PlannedRun, RunsPlan
from ddct_bringup.programs.score import main as score
from ddct_bringup.report import evidence
from ddct_bringup.report.evidence import FREQUENCY_FILE, evidence_of, loop_rows, without_evidence
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.run.timing_and_failure import (
    NOTE_FILE,
    TIMING_FILE,
    RunTiming,
    failed_run,
    note_failure,
    read_timing,
)
from ddct_bringup.scores.document import read_scores
from ddct_bringup.scores.scored_recording import ScoredRecording, score_any_bag
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.workflows.evidence import frequency_evidence
from ddct_controllers.workflows.evidence_types import FrequencyEvidence
from ddct_plant.files.json_records import json_text, read_json
from ddct_plant.scenario.settings import RunSettings
from fuzz.reader import Read, Reader

BAG = 'pi_0.mcap'


def run_readers(bag: Path, folder: Path) -> list[Reader]:
    """Return the readers of the files beside a good bag; they are made in a folder."""
    scored = score_any_bag(bag, bag.parent, packaged_limits())
    assert scored.recording is not None
    assert scored.settings is not None
    analyses = frequency_evidence(['pi', 'mpc3'], scored.settings)
    computed = frequency_evidence(['pi'], scored.settings)
    plan = _plan(scored.settings)
    scores, note = _scores(bag, folder), _note(scored.recording.custom_data, folder)
    return [
        Reader('timing', TIMING_FILE, in_folder(read_timing), (_timing(folder),)),
        Reader('failed_run', NOTE_FILE, in_folder(failed_run), (note,)),
        Reader('manifest', MANIFEST, in_folder(read_manifest), (_manifest(plan, folder),)),
        Reader('plan', 'plan.json', _planned, (json_text(plan).encode(),)),
        Reader('scores', SCORES_FILE, read_scores, (scores,)),
        Reader(
            'frequency',
            FREQUENCY_FILE,
            _evidence(scored, computed),
            (json_text(analyses).encode(),),
        ),
    ]


def in_folder(read: Read) -> Read:
    """Return a reader of a file whose folder `read` takes."""
    return lambda file: read(file.parent)


def _evidence(scored: ScoredRecording, computed: FrequencyEvidence) -> Read:
    """Return a reader of analyses beside a bag; where they are damaged `computed` is taken."""
    good = scored.recording
    assert good is not None

    def read(file: Path) -> object:
        recording = replace(good, path=file.parent / 'pi' / BAG)
        # To compute them each time would take a second.
        with patch.object(evidence, 'frequency_evidence', return_value=computed):
            found = evidence_of([replace(scored, recording=recording)])
        return loop_rows(found), without_evidence(found)

    return read


def _timing(folder: Path) -> bytes:
    RunTiming(update_times_us=[1.0, 2.5], safe_states={'/clutch': 3}).write(folder)
    return (folder / TIMING_FILE).read_bytes()


def _note(custom_data: Mapping[str, str], folder: Path) -> bytes:
    note_failure(folder, 'it stalled', custom_data)
    return (folder / NOTE_FILE).read_bytes()


def _plan(settings: RunSettings) -> RunsPlan:
    inputs = InputFiles()
    run = PlannedRun.of(RunPlan(settings, 'pi', 'headless'), inputs)
    limits = NamedLimits.of(packaged_limits(), inputs)
    return RunsPlan({ITSELF: run}, ComparisonPlan(limits, floors=False))


def _manifest(plan: RunsPlan, folder: Path) -> bytes:
    begin_manifest(folder, RUNS, plan, InputFiles())
    return (folder / MANIFEST).read_bytes()


def _planned(file: Path) -> object:
    """Return the plans of the runs that a plan of a result has."""
    plan = read_json(RunsPlan, file)
    return [each.headless_plan(file.parent) for each in plan.runs.values()]


def _scores(bag: Path, folder: Path) -> bytes:
    with redirect_stdout(io.StringIO()):
        assert score([str(bag), '--json', str(folder / SCORES_FILE)]) in (0, 1)
    return (folder / SCORES_FILE).read_bytes()
