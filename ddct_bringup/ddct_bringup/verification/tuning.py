# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Repeat the trials of a tuning and its held-out runs, and compare rows, files and front."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.campaign.manifest import MANIFEST as CAMPAIGN_MANIFEST
from ddct_bringup.campaign.manifest import Manifest
from ddct_bringup.campaign.rows import Row
from ddct_bringup.digests.digest_file import read_digests
from ddct_bringup.tuning.conduct import batches_of, computed_batch
from ddct_bringup.tuning.evaluation import evaluation
from ddct_bringup.tuning.front import best_of, front_of
from ddct_bringup.tuning.held_out import (
    HELD_OUT,
    held_out_campaign,
    held_out_trials,
    judged_trials,
)
from ddct_bringup.tuning.manifest import MANIFEST, TuningManifest
from ddct_bringup.tuning.record import (
    RUNS,
    TRIALS,
    batch_files,
    read_batch,
    read_entries,
    trials_of,
)
from ddct_bringup.tuning.result import result_of
from ddct_bringup.tuning.specification.goals import UPDATE_TIME
from ddct_bringup.tuning.trial import Trial
from ddct_bringup.tuning.tuned_files import tuned_files
from ddct_bringup.tuning.tuned_names import RESULT
from ddct_bringup.tuning.tuning import Tuning
from ddct_bringup.verification.campaign import verified_campaign
from ddct_bringup.verification.comparison import Comparison, plain_json, recorded_json
from ddct_bringup.verification.request import VerificationRequest
from ddct_bringup.verification.result import RepetitionResult
from ddct_plant.base.errors import DdctError
from ddct_plant.files.input_file import read_text_file


def verified_tuning(request: VerificationRequest) -> Iterator[RepetitionResult]:
    """
    Yield the results of manifest, trials, controller files, held-out campaign and front.

    Raise DdctError for a tuning that is not finished.
    """
    manifest = TuningManifest.read(request.folder)
    tuning = manifest.tuning(request.limits, request.files)
    yield _verified_manifest(request, manifest, tuning)
    trials: list[Trial] = []
    with evaluation(tuning, request.workers, lambda: False) as computed:
        for batch, size in enumerate(batches_of(tuning.spec.trials)):
            recorded = read_batch(request.folder, batch)
            if recorded is None or len(recorded) != size:
                raise DdctError(f'{request.folder}: trials are missing: finish it with --resume')
            again = computed_batch(
                tuning,
                computed,
                {each.number: each.values for each in recorded},
                trials,
                partial(_with_recorded_time, recorded),
            )
            rows, entries = batch_files(request.folder, batch)
            name = f'trials {again[0].number} to {again[-1].number}'
            yield _verified_trials(request, tuning, again, entries, rows, name)
            trials += again
    entries, rows = request.folder / TRIALS, request.folder / RUNS
    yield _verified_trials(request, tuning, trials, entries, rows, f'{TRIALS}, {RUNS}')
    front = front_of(trials, tuning.spec)
    if front:
        judged = judged_trials(front, best_of(front, tuning.spec), trials)
        yield _verified_files(request, tuning, judged, best_of(front, tuning.spec))
        yield from _verified_held_out(request, manifest, tuning, judged)
        yield _verified_result(request, tuning, trials, judged)


def _with_recorded_time(known: Sequence[Trial], trial: Trial) -> Trial:
    """Return a trial with its recorded update time, which no repetition gives again."""
    further = next(each.further for each in known if each.number == trial.number)
    if UPDATE_TIME not in further:
        return trial
    return replace(trial, further={**trial.further, UPDATE_TIME: further[UPDATE_TIME]})


def _of(request: VerificationRequest, name: str, comparison: Comparison) -> RepetitionResult:
    return RepetitionResult.of(name, comparison, same_environment=request.same_environment)


def _verified_manifest(
    request: VerificationRequest, manifest: TuningManifest, tuning: Tuning
) -> RepetitionResult:
    """Compare code and version with those of the digests, and the files with what they are."""
    comparison = Comparison()
    environment = request.digests.environment
    comparison.add({'key': 'code_digest'}, manifest.code_digest, environment.code)
    comparison.add({'key': 'version'}, manifest.version, environment.version)
    comparison.add_nested('limits', manifest.limits, plain_json(request.limits.origin))
    if request.same_code or not tuning.judged.is_packaged:
        again = Judged.of(tuning.judged.path).digests
        comparison.add_nested('digests', manifest.controller['digests'], plain_json(dict(again)))
    if request.same_code:
        digest = manifest.digest_of_cases(tuning)
        comparison.add({'key': 'campaign_digest'}, manifest.campaign_digest, digest)
    return _of(request, MANIFEST, comparison)


def _verified_trials(
    request: VerificationRequest,
    tuning: Tuning,
    again: Sequence[Trial],
    entries: Path,
    rows: Path,
    name: str,
) -> RepetitionResult:
    """Compare the entries and the rows of trials in two files with those computed again."""
    comparison = Comparison()
    stored = read_entries(entries)
    comparison.add({'key': 'number of trials'}, len(stored), len(again))
    for entry, recorded, trial in zip(stored, trials_of(stored, rows), again, strict=False):
        key = f'trial {trial.number}'
        comparison.add_nested(key, plain_json(entry), plain_json(trial.entry(tuning.spec)))
        comparison.add({'key': f'rows of {key}'}, len(recorded.rows), len(trial.rows))
        for ours, theirs in zip(recorded.rows, trial.rows, strict=False):
            _compare_rows(comparison, trial.number, ours, theirs)
    return _of(request, name, comparison)


def _compare_rows(comparison: Comparison, number: int, ours: Row, theirs: Row) -> None:
    for name, value in ours.items():
        again: Any = theirs[name]
        if isinstance(again, (dict, list, tuple)):  # the file has such a value as text
            continue
        place = {'trial': number, 'row': ours['index'], 'signal': name}
        comparison.add(place, value, again)


def _verified_files(
    request: VerificationRequest, tuning: Tuning, judged: Sequence[Trial], best: Trial
) -> RepetitionResult:
    """Compare the controller files with those of the trials."""
    comparison = Comparison()
    for name, text in tuned_files(tuning, request.folder, judged, best).items():
        comparison.add({'file': name}, read_text_file(request.folder / name), text)
    return _of(request, 'controller files', comparison)


def _verified_held_out(
    request: VerificationRequest,
    manifest: TuningManifest,
    tuning: Tuning,
    judged: Sequence[Trial],
) -> Iterator[RepetitionResult]:
    """Compare the specification of the held-out cases, then yield the results of the campaign."""
    folder: Path = request.folder / HELD_OUT
    if not (folder / CAMPAIGN_MANIFEST).is_file():
        raise DdctError(f'{folder}: the held-out runs are missing: finish it with --resume')
    campaign = held_out_campaign(tuning, request.folder, judged, manifest.code_digest)
    comparison = Comparison()
    known: Mapping[str, Any] = Manifest.read(folder).spec
    comparison.add_nested('spec', plain_json(known), plain_json(dict(campaign.spec.content)))
    yield _of(request, f'{HELD_OUT}: cases', comparison)
    digests = read_digests(folder)
    inner = replace(request, folder=folder, digests=digests, files=request.folder)
    for found in verified_campaign(inner):
        yield replace(found, run=f'{HELD_OUT}: {found.run}')


def _verified_result(
    request: VerificationRequest, tuning: Tuning, trials: Sequence[Trial], judged: Sequence[Trial]
) -> RepetitionResult:
    """Compare `front.json` with the result of the recorded trials."""
    comparison = Comparison()
    folder = request.folder
    seed = Manifest.read(folder / HELD_OUT).root_seed
    again = result_of(tuning, trials, held_out_trials(tuning, folder, judged), seed)
    comparison.add_nested('', recorded_json(folder / RESULT), plain_json(again))
    return _of(request, RESULT, comparison)
