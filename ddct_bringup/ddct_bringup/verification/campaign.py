# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Repeat the runs of a campaign, and compare rows, shards, manifest and summary."""

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from itertools import islice
from pathlib import Path
from typing import Any

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
from ddct_bringup.verification.comparison import BOUND, Comparison, plain_json, recorded_json
from ddct_bringup.verification.request import VerificationRequest
from ddct_bringup.verification.result import RepetitionResult
from ddct_bringup.verification.rounding_bound import LARGEST, bound_of_row
from ddct_plant.base.errors import DdctError
from ddct_plant.program.progress import Progress
from ddct_plant.program.workers import in_processes

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
    compared: list[tuple[str, Comparison, dict[int, RowPair]]] = []
    progress = Progress('runs', campaign.runs)
    with scored_runs(
        campaign, request.limits, workers=request.workers, floors=campaign.spec.floors
    ) as found:
        for number, label in enumerate(campaign.labels):
            first = number * campaign.cases
            comparison, beyond = Comparison(), dict[int, RowPair]()
            for start in range(first, first + campaign.cases, _TOGETHER):
                count = min(_TOGETHER, first + campaign.cases - start)
                for pair in _pairs(table.slice(start, count), schema, list(islice(found, count))):
                    if pair.amplified and not request.same_environment:
                        beyond[pair.index] = pair
                    else:
                        pair.compare(comparison, BOUND)
                progress.update(start + count)
            name = f'{label}: rows {first} to {first + campaign.cases - 1}'
            compared.append((name, comparison, beyond))
    progress.end()
    for name, comparison, beyond in compared:
        for index, bound in _bounds(request, campaign, list(beyond)):
            beyond[index].compare(comparison, bound)
        yield RepetitionResult.of(name, comparison, same_environment=request.same_environment)


@dataclass(frozen=True)
class RowPair:
    """A recorded row and its repetition, in the columns that both have."""

    index: int
    values: Mapping[str, tuple[Any, Any]]
    """Recorded and repeated value by column."""

    def compare(self, comparison: Comparison, bound: float) -> None:
        """Add all columns to a comparison."""
        for name, (ours, theirs) in self.values.items():
            comparison.add({'row': self.index, 'signal': name}, ours, theirs, bound)

    @property
    def amplified(self) -> bool:
        """Whether it is beyond `BOUND`, by so little that rounding may be the cause."""
        alone = Comparison()
        self.compare(alone, BOUND)
        return BOUND < alone.largest <= LARGEST


def _pairs(recorded: pa.Table, schema: pa.Schema, repeated: list[ScoredRow]) -> Iterator[RowPair]:
    """Yield the pairs of rows; a file of another version may lack some columns."""
    rows = [each.row() for each in repeated]
    columns = {}
    for field in schema:
        if field.name in recorded.column_names:
            again = arrow_column(field.type, [row[field.name] for row in rows]).to_pylist()
            columns[field.name] = (recorded[field.name].to_pylist(), again)
    for place, row in enumerate(rows):
        values = {name: (ours[place], again[place]) for name, (ours, again) in columns.items()}
        yield RowPair(row[INDEX], values)


def _bounds(
    request: VerificationRequest, campaign: Campaign, indices: list[int]
) -> Iterator[tuple[int, float]]:
    """Yield the index of each of some rows with its bound, computed by worker processes."""

    def bound(place: int) -> float:
        (run,) = campaign.planned(indices[place], indices[place] + 1)
        return bound_of_row(run, request.limits)

    with in_processes(bound, len(indices), request.workers, chunk=1) as found:
        yield from zip(indices, found, strict=True)


def _verified_shards(request: VerificationRequest, table: pa.Table) -> RepetitionResult:
    """Compare the rows of the shards with those of the results file, which is made of them."""
    comparison = Comparison()
    start = 0
    for path in sorted((request.folder / SHARDS).glob('*.parquet')):
        rows = _shard(path, table.num_rows)
        same = rows.equals(table.slice(start, rows.num_rows))
        reason = f'other rows than those of {RESULTS}'
        comparison.add({'file': f'{SHARDS}/{path.name}', 'reason': reason}, same, True)
        start += rows.num_rows
    comparison.add({'key': 'rows of all shards'}, start, table.num_rows)
    return RepetitionResult.of(SHARDS, comparison, same_environment=request.same_environment)


def _shard(path: Path, most_rows: int) -> pa.Table:
    try:
        return read_parquet(path, most_rows)
    except (OSError, pa.ArrowException) as error:
        raise DdctError(f'{path}: cannot be read ({error})') from error


def _verified_summary(
    request: VerificationRequest, manifest: Manifest, table: pa.Table
) -> RepetitionResult:
    """Compare `summary.json` with the summary of the recorded rows."""
    stored = recorded_json(request.folder / SUMMARY)
    comparison = Comparison()
    comparison.add_nested('', stored, plain_json(summary_of(results_of(manifest, table))))
    return RepetitionResult.of(SUMMARY, comparison, same_environment=request.same_environment)
