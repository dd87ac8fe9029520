# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Repeat the runs of a benchmark, and compare its rows, seeds and result."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from ddct_bringup.benchmark.cases import Cases, packaged_folder
from ddct_bringup.benchmark.conduct import campaigns_of
from ddct_bringup.benchmark.file_names import RESULT
from ddct_bringup.benchmark.judged import Judged
from ddct_bringup.benchmark.manifest import MANIFEST, BenchmarkManifest, JudgedEntry
from ddct_bringup.benchmark.release import ROWS, release_rows
from ddct_bringup.benchmark.report.folder import result_in
from ddct_bringup.campaign.manifest import Manifest
from ddct_bringup.digests.digest_file import read_digests
from ddct_bringup.verification.campaign import verified_campaign
from ddct_bringup.verification.comparison import Comparison, plain_json, recorded_json
from ddct_bringup.verification.request import VerificationRequest
from ddct_bringup.verification.result import RepetitionResult


def verified_benchmark(request: VerificationRequest) -> Iterator[RepetitionResult]:
    """
    Yield the results of manifest, rows of the release, campaigns and result.

    Raise DdctError for a benchmark that is not finished.
    """
    manifest = BenchmarkManifest.read(request.folder)
    yield _verified_manifest(request, manifest)
    yield _verified_release(request, manifest)
    for entry in manifest.controllers:
        yield from _verified_controller(request, manifest, entry)
    yield _verified_result(request)


def _verified_manifest(
    request: VerificationRequest, manifest: BenchmarkManifest
) -> RepetitionResult:
    """Compare the release, the cases, and each seed with that of the digests."""
    comparison = Comparison()
    environment = request.digests.environment
    comparison.add({'key': 'code_digest'}, manifest.code_digest, environment.code)
    comparison.add({'key': 'version'}, manifest.version, environment.version)
    if request.same_code:
        ours = plain_json(Cases.packaged().content)
        comparison.add_nested('cases', plain_json(manifest.cases), ours)
        comparison.add_nested('limits', manifest.limits, plain_json(request.limits.origin))
    for number, entry in enumerate(manifest.controllers):
        judged = Judged(entry.name, entry.chosen, request.folder, entry.digests)
        again = JudgedEntry.of(judged, manifest.code_digest, manifest.judge_seed)
        place = {'key': f'controllers[{number}].held_out_seed'}
        comparison.add(place, entry.held_out_seed, again.held_out_seed)
    return RepetitionResult.of(MANIFEST, comparison, same_environment=request.same_environment)


def _verified_release(
    request: VerificationRequest, manifest: BenchmarkManifest
) -> RepetitionResult:
    """Compare the rows of the release with those that this release has, if it is the same."""
    origin = release_rows(request.folder).origin
    other = origin.code != manifest.code_digest
    note = f'computed by other code: {origin.text}' if other else ''
    if not request.same_code:
        return RepetitionResult.by_digest(
            ROWS, '; '.join(filter(None, ('rows of another release', note)))
        )
    comparison = Comparison()
    same = (request.folder / ROWS).read_bytes() == (packaged_folder() / ROWS).read_bytes()
    comparison.add({'file': ROWS, 'reason': 'other rows than those of the release'}, same, True)
    found = RepetitionResult.of(ROWS, comparison, same_environment=request.same_environment)
    return replace(found, note=note)


def _verified_controller(
    request: VerificationRequest, manifest: BenchmarkManifest, entry: JudgedEntry
) -> Iterator[RepetitionResult]:
    """Yield the results of the campaigns of a controller."""
    folder = request.folder / entry.name
    campaigns = sorted(file.parent for file in folder.glob('*/manifest.json'))
    for each in campaigns:
        name = f'{entry.name}/{each.name}'
        inner = replace(request, folder=each, digests=read_digests(each))
        yield _verified_cases(inner, manifest, entry, name)
        for found in verified_campaign(inner):
            yield replace(found, run=f'{name}: {found.run}')


def _verified_cases(
    request: VerificationRequest, manifest: BenchmarkManifest, entry: JudgedEntry, name: str
) -> RepetitionResult:
    """Compare the specification of a campaign with that which the manifest gives."""
    known = Manifest.read(request.folder)
    place = request.files or Path(known.folder)
    judged = Judged(entry.name, entry.chosen, place, entry.digests)
    judged.require_unchanged()
    campaigns = campaigns_of(judged, manifest.run_cases, entry.held_out_seed)
    comparison = Comparison()
    found = campaigns.get(request.folder.name)
    expected = plain_json(found.spec.content) if found else None
    comparison.add_nested('spec', plain_json(known.spec), expected)
    if request.same_code or not judged.is_packaged:
        again = Judged.of(judged.path).digests
        comparison.add_nested('digests', dict(entry.digests), dict(again))
    return RepetitionResult.of(
        f'{name}: cases', comparison, same_environment=request.same_environment
    )


def _verified_result(request: VerificationRequest) -> RepetitionResult:
    """Compare `result.json` with the result of the recorded rows."""
    comparison = Comparison()
    again = plain_json(result_in(request.folder))
    comparison.add_nested('', recorded_json(request.folder / RESULT), again)
    return RepetitionResult.of(RESULT, comparison, same_environment=request.same_environment)
