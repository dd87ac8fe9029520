# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The tables and figures of the page of a finished campaign, benchmark or tuning, for Python."""

from collections.abc import Callable, Mapping
from pathlib import Path

from ddct_bringup.benchmark.file_names import PAGE
from ddct_bringup.benchmark.report.folder import benchmark_in
from ddct_bringup.campaign_report.folder import campaign_in
from ddct_bringup.documents.document import Document
from ddct_bringup.manifest.manifest import BENCHMARK, CAMPAIGN, TUNING, Kind, read_manifest
from ddct_bringup.tuning.report.folder import tuning_in
from ddct_plant.base.errors import DdctError

_READERS: Mapping[Kind, Callable[[Path], Document]] = {
    BENCHMARK: benchmark_in,
    CAMPAIGN: campaign_in,
    TUNING: tuning_in,
}


def document(folder: str | Path) -> Document:
    """
    Return the document of a finished campaign, benchmark or tuning: what its page has.

    `document(folder).table(title)` and `.figure(title)` are a table and a figure by its title, or
    by that of its section. A notebook shows them where they end a cell. Raise DdctError for a
    folder without such a result.
    """
    result = Path(folder)
    kind = read_manifest(result).kind
    if kind not in _READERS:
        raise DdctError(f'its page is made by ddct report: open {PAGE}', place=result)
    return _READERS[kind](result)
