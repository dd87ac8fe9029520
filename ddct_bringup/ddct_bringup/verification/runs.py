# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Repeat the runs in a folder of bags headless, and compare signals, descriptions and scores."""

import re
import tempfile
from collections.abc import Iterator
from dataclasses import asdict, replace
from pathlib import Path

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.run_facts import described_run
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.bag.trajectory_bag import write_trajectory
from ddct_bringup.digests.digest_file import RunDigests
from ddct_bringup.digests.writing import ITSELF
from ddct_bringup.report.evidence import FREQUENCY_FILE
from ddct_bringup.run.execution import simulate
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.run.timing_and_failure import RunFailure, failed_run
from ddct_bringup.scores.bags import bag_name, find_bags
from ddct_bringup.verification.comparison import BOUND, SAME_BITS, Comparison, plain_json
from ddct_bringup.verification.repetition import plan_of
from ddct_bringup.verification.request import VerificationRequest
from ddct_bringup.verification.result import RepetitionResult
from ddct_bringup.verification.rounding_bound import LARGEST, bound_of_run
from ddct_bringup.verification.scores import SCORES, verified_frequency, verified_scores
from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError
from ddct_plant.scenario.file import scenario_digest
from ddct_plant.signals.gain_changes import changes_note
from ddct_plant.signals.topics import RUN_INFO

METADATA = 'metadata.yaml'
_FOLDERS = re.compile(r'[^\s(]*/')
"""Folders of a path in a text, which may be others elsewhere."""
_COMMIT = 'commit'
"""Custom data that may change while the code stays."""
_REAL_TIME = 'real time: only its digests and scores can be checked'


def verified_runs(request: VerificationRequest) -> Iterator[RepetitionResult]:
    """Yield the result of every run of a folder, then those of its scores and loop analyses."""
    names = set()
    for bag in find_bags(request.folder):
        name = bag_name(bag, request.folder)
        names.add(name)
        yield replace(_verified_bag(request, bag, name), run=_shown(request, name))
    for name in sorted(request.digests.runs.keys() - names):
        yield RepetitionResult.failed(name, 'it has digests, but there is no bag')
    if (request.folder / SCORES).exists():
        yield verified_scores(request)
    if (request.folder / FREQUENCY_FILE).exists():
        yield verified_frequency(request)


def _shown(request: VerificationRequest, name: str) -> str:
    """Return the name of a bag in results; a run's own folder has that of the folder."""
    return request.folder.resolve().name if name == ITSELF else name


def _verified_bag(request: VerificationRequest, bag: Path, name: str) -> RepetitionResult:
    digests = request.digests.runs.get(name)
    if digests is None:
        return RepetitionResult.failed(name, 'no digests of this run')
    try:
        if failure := failed_run(bag if bag.is_dir() else bag.parent):
            return _verified_failure(request, bag, name, digests, failure)
        recording = read_bag(bag)
        result = (
            _verified_recording(request, recording, name, digests)
            if recording.facts.lockstep
            else RepetitionResult.by_digest(name, _REAL_TIME)
        )
        notes = (result.note, changes_note(recording.gain_changes))
        return replace(result, note='; '.join(filter(None, notes)))
    except DdctError as error:
        return RepetitionResult.failed(name, error)


def _verified_recording(
    request: VerificationRequest, recording: Recording, name: str, digests: RunDigests
) -> RepetitionResult:
    plan = plan_of(request, recording, digests)
    comparison = Comparison()
    if request.same_code:
        comparison.add(
            {'key': 'scenario'}, digests.scenario, scenario_digest(plan.settings.scenario)
        )
    try:
        repeated, _ = simulate(plan, recording.gain_changes)
    except FOREIGN_FAILURES as error:
        return RepetitionResult.failed(name, f'its repetition fails: {error}')
    _compare_descriptions(comparison, recording, repeated, same_code=request.same_code)
    _compare_signals(comparison, recording, repeated, None if request.same_environment else plan)
    if request.same_code and comparison.state(same_environment=True) == SAME_BITS:
        _compare_bytes(comparison, recording, repeated)
    return RepetitionResult.of(name, comparison, same_environment=request.same_environment)


def _compare_signals(
    comparison: Comparison, recording: Recording, repeated: Recording, plan: RunPlan | None
) -> None:
    """Compare all signals; with a plan, those beyond the bound by that of the run."""
    ours, theirs = recording.trajectory, repeated.trajectory
    alone = Comparison()
    alone.add_trajectories(ours, theirs)
    if plan is not None and BOUND < alone.largest <= LARGEST:
        comparison.bound = bound_of_run(plan, recording.gain_changes)
    comparison.add_trajectories(ours, theirs)


def _verified_failure(
    request: VerificationRequest, bag: Path, name: str, digests: RunDigests, failure: RunFailure
) -> RepetitionResult:
    """Return the result of a run that failed: its repetition has to fail with the same reason."""
    facts = failure.facts
    if facts is None:
        return RepetitionResult.failed(name, failure.reason)
    if not facts.lockstep:
        return RepetitionResult.by_digest(name, _REAL_TIME)
    settings, _ = described_run(failure.custom_data)
    described = Recording(bag, Trajectory({}), facts, failure.custom_data, settings=settings)
    comparison = Comparison()
    try:
        simulate(plan_of(request, described, digests))
        repeated = 'its repetition does not fail'
    except FOREIGN_FAILURES as error:
        repeated = str(error)
    # In a graph the name of the node and its log stand around the reason.
    ours, theirs = (_FOLDERS.sub('', text) for text in (failure.reason, repeated))
    comparison.add({'key': 'reason'}, theirs if theirs in ours else ours, theirs)
    return RepetitionResult.of(name, comparison, same_environment=request.same_environment)


def _compare_descriptions(
    comparison: Comparison, recording: Recording, repeated: Recording, *, same_code: bool
) -> None:
    """Compare facts, custom data and `run_info`; of another code only the facts."""
    comparison.add_nested(
        '', plain_json(asdict(recording.facts)), plain_json(asdict(repeated.facts))
    )
    if not same_code:
        return
    for part, ours, theirs in (
        ('custom_data', recording.custom_data, repeated.custom_data),
        (RUN_INFO.name, recording.run_info, repeated.run_info),
    ):
        kept = [{key: each[key] for key in each if key != _COMMIT} for each in (ours, theirs)]
        comparison.add_nested(part, *map(plain_json, kept))


def _compare_bytes(comparison: Comparison, recording: Recording, repeated: Recording) -> None:
    """Compare the bytes of the bag with those of a bag of the same messages."""
    with tempfile.TemporaryDirectory(prefix='ddct-verify-') as place:
        folder = Path(place)
        written = write_trajectory(
            repeated.trajectory,
            folder,
            recording.path.name.removesuffix('_0.mcap'),
            recording.custom_data,
            recording.run_info,
        )
        for file in (written, folder / METADATA):
            ours = recording.path.parent / file.name
            same = ours.is_file() and ours.read_bytes() == file.read_bytes()
            reason = 'other bytes than those of the same signals'
            comparison.add({'file': file.name, 'reason': reason}, same, True)
