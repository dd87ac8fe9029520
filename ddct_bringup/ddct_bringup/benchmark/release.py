# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Rows of the packaged controllers on the development cases, which are kept with a release.

`tools/run benchmark_rows` computes them and writes them into the sources.
"""

from dataclasses import dataclass, replace
from importlib.resources.abc import Traversable
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as parquet

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.campaign.arrow_columns import read_parquet
from ddct_bringup.campaign.columns import CONTROLLER, SEED
from ddct_bringup.campaign.conduct import carry_out
from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.campaign.plan import RecordedCampaign
from ddct_bringup.campaign.rows import STATE
from ddct_bringup.campaign.spec import CampaignSpec
from ddct_bringup.campaign_report.reading import read_table
from ddct_bringup.evaluation.quantities import OF_RUNS
from ddct_bringup.manifest.manifest import MANIFEST
from ddct_bringup.manifest.origin import CodeOrigin
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.registry import own_controller_names
from ddct_plant.base.errors import DdctError
from ddct_plant.files.output_file import write_bytes

ROWS = 'development.parquet'
"""File with the rows, of which each benchmark has a copy."""
PROGRAM = 'tools/run benchmark_rows'
"""Command that computes the rows again, in a clone."""
_CASES, _CODE = b'cases_digest', b'code_digest'
_VERSION, _COMMIT = b'version', b'commit'
_OUTCOME = ('valid', 'reason', STATE, 'why')


@dataclass(frozen=True)
class ReleaseRows:
    """Rows of the controllers of a release on the development cases."""

    rows: CaseRows
    cases_digest: str
    """Digest of the cases that were run."""
    origin: CodeOrigin
    """Code that computed the rows."""

    def other_code(self, origin: CodeOrigin) -> str:
        """Return what to know beside rows of another `origin`; empty for rows of the same code."""
        if self.origin.code == origin.code:
            return ''
        return (
            'the development rows of the packaged controllers were computed by other code '
            f'({self.origin.text}) than all other rows ({origin.text}): differences between them '
            f'may be those of the code. {PROGRAM}, in a clone, computes these rows again'
        )

    def of(self, cases: Cases) -> 'ReleaseRows':
        """Return the rows of the cases that run; raise DdctError for cases without rows."""
        if cases.digest != self.cases_digest:
            raise DdctError(f'{ROWS} has the rows of other cases: run {PROGRAM}')
        campaign = cases.planned
        samples, each = campaign.samples, cases.whole.samples
        whole = [case // samples * each + case % samples for case in range(campaign.cases)]
        if max(whole) >= self.rows.cases:
            raise DdctError(f'{ROWS} lacks cases: run {PROGRAM}')
        return replace(self, rows=self.rows.of_cases(whole))


def columns_kept(spec: CampaignSpec) -> list[str]:
    """Return the columns that a release keeps: what runs are evaluated by, and what varied."""
    varied = [key for key in spec.vary if key != SEED]
    grid = [key for key, values in spec.grid.items() if key == SCENARIO or len(values) > 1]
    return [CONTROLLER, SEED, *grid, *varied, *_OUTCOME, *OF_RUNS]


def release_rows(folder: Traversable | Path) -> ReleaseRows:
    """Return the rows of a release in a folder; raise DdctError where they cannot be read."""
    try:
        table = read_parquet(Path(str(folder / ROWS)))
        known, rows = table.schema.metadata, CaseRows(table)
        version, commit, code = (known[key].decode() for key in (_VERSION, _COMMIT, _CODE))
        cases = known[_CASES].decode()
        return ReleaseRows(rows, cases, CodeOrigin(version, commit, code))
    except (OSError, pa.ArrowException, LookupError, TypeError, ValueError) as error:
        why = next(iter(str(error).splitlines()), type(error).__name__)
        raise DdctError(f'{folder}: its rows of the release cannot be read ({why})') from error


def copy_release_rows(rows: Traversable, target: Path) -> None:
    """Write the rows in the folder of a release into another; raise DdctError on failure."""
    write_bytes(str(target / ROWS), (rows / ROWS).read_bytes())


def write_release_rows(work: Path, target: Path, workers: int | None = None) -> None:
    """
    Compute the rows of all packaged controllers in the folder `work`, and write them to `target`.

    The runs of an earlier start with the same code are taken. Raise DdctError where that fails,
    and for a folder `work` with runs of other code.
    """
    cases = Cases.packaged()
    campaign = cases.development(own_controller_names(), Path())
    resume = (work / MANIFEST).exists()
    if resume and (before := RecordedCampaign.read(work).origin).code != CodeOrigin.here().code:
        raise DdctError(
            f'it has runs of other code, {before.text}: remove it, and run {PROGRAM} again',
            place=work,
        )
    carry_out(campaign, packaged_limits(), work, workers=workers, resume=resume)
    recorded = RecordedCampaign.read(work)
    table = read_table(work, recorded).select(columns_kept(campaign.spec))
    origin = recorded.origin
    texts = {_VERSION: origin.version, _COMMIT: origin.commit, _CODE: origin.code}
    texts[_CASES] = cases.digest
    table = table.replace_schema_metadata({key: text.encode() for key, text in texts.items()})
    _write_table(table, target / ROWS)


def _write_table(table: pa.Table, path: Path) -> None:
    """Write a table as small as Parquet can: the bytes of numbers are split by their place."""
    numbers = [field.name for field in table.schema if field.type == pa.float64()]
    parquet.write_table(
        table,
        path,
        compression='zstd',
        compression_level=19,
        use_dictionary=[name for name in table.column_names if name not in numbers],
        use_byte_stream_split=numbers,
    )
