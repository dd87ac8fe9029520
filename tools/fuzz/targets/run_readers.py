# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Readers of what stands beside bags: times, failures, digests, scores and loop analyses."""

import io
from collections.abc import Mapping
from contextlib import redirect_stdout
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

from ddct_bringup.digests.digest_file import DIGESTS, RUNS, Digests, RunDigests, read_digests
from ddct_bringup.digests.environment import this_environment
from ddct_bringup.digests.writing import ITSELF
from ddct_bringup.programs.score import main as score
from ddct_bringup.report import evidence
from ddct_bringup.report.evidence import FREQUENCY_FILE, evidence_of, loop_rows, without_evidence
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
from ddct_bringup.verification.request import VerificationRequest
from ddct_bringup.verification.runs import verified_runs
from ddct_bringup.verification.scores import SCORES, verified_scores
from ddct_controllers.workflows.evidence import frequency_evidence
from ddct_controllers.workflows.evidence_types import FrequencyEvidence
from ddct_plant.files.json_records import json_text
from fuzz.reader import Read, Reader

BAG = 'pi_0.mcap'


def run_readers(bag: Path, folder: Path) -> list[Reader]:
    """Return the readers of the files beside a good bag; they are made in a folder."""
    scored = score_any_bag(bag, bag.parent, packaged_limits())
    assert scored.recording is not None
    assert scored.settings is not None
    analyses = frequency_evidence(['pi', 'mpc3'], scored.settings)
    computed = frequency_evidence(['pi'], scored.settings)
    scores, note = _scores(bag, folder), _note(scored.recording.custom_data, folder)
    return [
        Reader('timing', TIMING_FILE, in_folder(read_timing), (_timing(folder),)),
        Reader('failed_run', NOTE_FILE, in_folder(failed_run), (note,)),
        Reader('repeated_failure', NOTE_FILE, _beside(bag, _repeated), (note,)),
        Reader('digests', DIGESTS, in_folder(read_digests), (_digests(),)),
        Reader('scores', SCORES, read_scores, (scores,)),
        Reader('verified_scores', SCORES, _beside(bag, _verified), (scores,)),
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


def request_of(folder: Path, runs: Mapping[str, RunDigests]) -> VerificationRequest:
    """Return the request to verify a folder with these runs."""
    digests = Digests(1, RUNS, {}, this_environment(), runs)
    return VerificationRequest(folder, digests, packaged_limits(), workers=1)


def _beside(bag: Path, read: Read) -> Read:
    """Return a reader of a file in the folder of a bag, which `read` takes."""
    content = bag.read_bytes()

    def beside(file: Path) -> object:
        (file.parent / BAG).write_bytes(content)
        return read(file.parent)

    return beside


def _repeated(folder: Path) -> object:
    return list(verified_runs(request_of(folder, {ITSELF: RunDigests('', 'pi', {})})))


def _verified(folder: Path) -> object:
    return verified_scores(request_of(folder, {}))


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


def _digests() -> bytes:
    return Digests(1, RUNS, {BAG: 'ab'}, this_environment()).text().encode()


def _scores(bag: Path, folder: Path) -> bytes:
    with redirect_stdout(io.StringIO()):
        assert score([str(bag), '--json', str(folder / SCORES)]) in (0, 1)
    return (folder / SCORES).read_bytes()
