# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of the packaged tunings, from the `front.json` that `ddct tune` wrote for each."""

from collections.abc import Iterator, Mapping
from pathlib import Path

from ddct_bringup.documents.terminal import text_table
from ddct_bringup.tuning.report.document import effects_table, entries_table
from ddct_bringup.tuning.result import FrontEntry, TuningResult
from ddct_bringup.tuning.specification.packaged_specs import packaged_specs
from ddct_plant.files.json_records import read_json
from ddct_plant.program.table import TextTable

FOLDER = Path(__file__).resolve().parents[2] / 'examples' / 'tuning'
"""Folder with the results, by the names of the specifications."""


def tuning_tables() -> Mapping[str, TextTable]:
    """Return the front and the effects of each packaged tuning."""
    found = {}
    for name in packaged_specs():
        result = read_json(TuningResult, FOLDER / f'{name}.json')
        found[name] = text_table(entries_table(result, dict(_entries(result))))
        found[f'{name}_effects'] = text_table(effects_table(result))
    return found


def _entries(result: TuningResult) -> Iterator[tuple[str, FrontEntry]]:
    """Yield the ends of the front, its best trial, and the values from before."""
    front = result.front
    if result.before:
        yield 'before', result.before
    for entry in front:
        if entry.number == result.best:
            yield f'{entry.number}, best', entry
        elif entry in (front[0], front[-1]):
            yield f'{entry.number}, end of the front', entry
