# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of the seeded defects, from the records that `make mutants JSON=...` wrote."""

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

from ddct_plant.program.table import Table
from generator.pages import DOCS

RECORDS = DOCS / 'examples' / 'mutants.json'
"""File with the records of all defects, by their claims."""
CAUGHT = 'caught'


def mutant_tables() -> Mapping[str, Table]:
    """Return the counts by part of the product, those by commit, and the defects that live."""
    return tables_of(json.loads(RECORDS.read_text(encoding='utf-8')))


def tables_of(records: Mapping[str, Mapping[str, str]]) -> Mapping[str, Table]:
    """Return the tables of these records."""
    each = list(records.values())
    tried = [record for record in each if 'outcome' in record]
    parts = sorted({_part(record['file']) for record in each})
    rows = [
        _counts(part, [record for record in each if _part(record['file']) == part])
        for part in parts
    ]
    runs = Counter((record['date'], record['commit']) for record in tried)
    caught = Counter((r['date'], r['commit']) for r in tried if r['outcome'] == CAUGHT)
    lives = [
        (record['file'], claim, record['outcome'])
        for claim, record in records.items()
        if record.get('outcome', CAUGHT) != CAUGHT
    ]
    return {
        'counts': Table(
            'Defects by the part of the product that they are seeded in',
            ('part', 'defects', 'caught', 'not caught', 'not tried yet'),
            [*rows, _counts('all', each)],
        ),
        'commits': Table(
            'When they were tried',
            ('date', 'commit', 'tried', 'caught'),
            [(*run, str(runs[run]), str(caught[run])) for run in sorted(runs)],
        ),
        'lives': Table(
            'Defects that were not caught',
            ('file', 'claim', 'outcome'),
            lives or [('none', '', '')],
        ),
    }


def _part(file: str) -> str:
    """Return the package and the folder in it, or two folders of a file outside of them."""
    first, *rest = Path(file).parent.parts
    return '/'.join([first, *[name for name in rest if name != first][:1]])


def _counts(part: str, records: Sequence[Mapping[str, str]]) -> tuple[str, ...]:
    outcomes = [record.get('outcome') for record in records]
    caught, untried = outcomes.count(CAUGHT), outcomes.count(None)
    counts = (len(outcomes), caught, len(outcomes) - caught - untried, untried)
    return (part, *map(str, counts))
