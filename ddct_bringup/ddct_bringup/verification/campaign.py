# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Repeat the runs of a campaign, and compare rows, shards, manifest and summary."""

from collections.abc import Iterator
from dataclasses import asdict
from itertools import islice
from pathlib import Path

import pyarrow as pa

from ddct_bringup.campaign.arrow_columns import arrow_column, read_parquet
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import INDEX, schema_of
from ddct_bringup.campaign.conduct import RESULTS, SHARDS
from ddct_bringup.campaign.manifest import MANIFEST, Manifest
from ddct_bringup.campaign.scored import ScoredRow, scored_runs
from ddct_bringup.campaign_report.folder import SUMMARY
from ddct_bringup.campaign_report.reading import read_table, results_of
from ddct_bringup.campaign_report.summary import summary_of
from ddct_bringup.verification.comparison import Comparison, plain_json
from ddct_bringup.verification.request import VerificationRequest
from ddct_bringup.verification.result import RepetitionResult
from ddct_plant.base.errors import DdctError
from ddct_plant.files.input_file import parse_json, read_text_file
from ddct_plant.program.progress import Progress

_MOST_BYTES = 100_000_000
"""Largest size of `summary.json` in bytes."""
_TOGETHER = 1000
"""Number of rows that are compared at once."""
_OF_PLACE = ('commit', 'folder')
"""Keys of the manifest that are not compared, since they may change while the campaign stays."""
_OF_CODE = ('version', 'code_digest', 'schema_version', 'shard_size')
"""Keys of the manifest that another code writes otherwise."""


def verified_campaign(request: VerificationRequest) -> Iterator[RepetitionResult]:
    """
    Yield the results of manifest, rows by controller, shards and summary of a campaign.

    Raise DdctError for a campaign that is not finished, or that this version cannot repeat.
    """
    folder = request.folder
    manifest = Manifest.read(folder)
    table = read_table(folder, manifest)
    manifest.require_limits(request.limits, folder)
    campaign = manifest.campaign(folder, request.files)
    yield _verified_manifest(request, manifest, campaign)
    yield from _verified_rows(request, table, campaign)
    yield _verified_shards(request, table)
    if (folder / SUMMARY).exists():
        yield _verified_summary(request, manifest, table)


def _verified_manifest(
    request: VerificationRequest, manifest: Manifest, campaign: Campaign
) -> RepetitionResult:
    ours, theirs = asdict(manifest), asdict(Manifest.of(campaign, request.limits))
    ignored = _OF_PLACE if request.same_code else (*_OF_PLACE, *_OF_CODE)
    comparison = Comparison()
    for key in ours:
        if key not in ignored:
            comparison.add_nested(key, plain_json(ours[key]), plain_json(theirs[key]))
    environment = request.digests.environment
    comparison.add({'key': 'code_digest'}, manifest.code_digest, environment.code)
    comparison.add({'key': 'version'}, manifest.version, environment.version)
    return RepetitionResult.of(MANIFEST, comparison, same_environment=request.same_environment)


def _verified_rows(
    request: VerificationRequest, table: pa.Table, campaign: Campaign
) -> Iterator[RepetitionResult]:
    """Yield the result of the rows of each controller, computed by worker processes."""
    schema = schema_of(campaign.spec)
    progress = Progress('runs', campaign.runs)
    with scored_runs(
        campaign, request.limits, workers=request.workers, floors=campaign.spec.floors
    ) as found:
        for number, label in enumerate(campaign.labels):
            first = number * campaign.cases
            comparison = Comparison()
            for start in range(first, first + campaign.cases, _TOGETHER):
                count = min(_TOGETHER, first + campaign.cases - start)
                repeated = list(islice(found, count))
                _compare_rows(comparison, table.slice(start, count), schema, repeated)
                progress.update(start + count)
            name = f'{label}: rows {first} to {first + campaign.cases - 1}'
            yield RepetitionResult.of(name, comparison, same_environment=request.same_environment)
    progress.end()


def _compare_rows(
    comparison: Comparison,
    recorded: pa.Table,
    schema: pa.Schema,
    repeated: list[ScoredRow],
) -> None:
    """Compare the columns of rows; a file of another version may lack some."""
    rows = [each.row() for each in repeated]
    columns = {}
    for field in schema:
        if field.name in recorded.column_names:
            again = arrow_column(field.type, [row[field.name] for row in rows]).to_pylist()
            columns[field.name] = (recorded[field.name].to_pylist(), again)
    for place, row in enumerate(rows):
        for name, (ours, theirs) in columns.items():
            comparison.add({'row': row[INDEX], 'signal': name}, ours[place], theirs[place])


def _verified_shards(request: VerificationRequest, table: pa.Table) -> RepetitionResult:
    """Compare the rows of the shards with those of the results file, which is made of them."""
    comparison = Comparison()
    start = 0
    for path in sorted((request.folder / SHARDS).glob('*.parquet')):
        rows = _shard(path)
        same = rows.equals(table.slice(start, rows.num_rows))
        reason = f'other rows than those of {RESULTS}'
        comparison.add({'file': f'{SHARDS}/{path.name}', 'reason': reason}, same, True)
        start += rows.num_rows
    comparison.add({'key': 'rows of all shards'}, start, table.num_rows)
    return RepetitionResult.of(SHARDS, comparison, same_environment=request.same_environment)


def _shard(path: Path) -> pa.Table:
    try:
        return read_parquet(path)
    except (OSError, pa.ArrowException) as error:
        raise DdctError(f'{path}: cannot be read ({error})') from error


def _verified_summary(
    request: VerificationRequest, manifest: Manifest, table: pa.Table
) -> RepetitionResult:
    """Compare `summary.json` with the summary of the recorded rows."""
    path = request.folder / SUMMARY
    try:
        stored = parse_json(read_text_file(path, _MOST_BYTES))
    except OSError as error:
        raise DdctError(f'{path}: cannot be read ({error.strerror})') from error
    comparison = Comparison()
    comparison.add_nested('', stored, plain_json(summary_of(results_of(manifest, table))))
    return RepetitionResult.of(SUMMARY, comparison, same_environment=request.same_environment)
