# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`make mutants JSON=...` keeps the outcome of each tried defect for the page."""

import json
import subprocess
from datetime import date
from pathlib import Path

import pytest
from generator.mutant_tables import RECORDS, tables_of
from mutant_entries import Mutant, read_mutants
from mutant_records import Records, commit_of, digest

HERE = Path(__file__).resolve().parent
FILE = 'ddct_plant/ddct_plant/models/sums.py'


def mutant(claim: str, replace: str = 'a - b') -> Mutant:
    return Mutant(claim, FILE, 'a + b', replace, ('ddct_plant/test/models/test_sums.py',))


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """Make a repository with one commit."""
    (tmp_path / 'docs').mkdir()
    for name in ('sums.py', 'docs/page.md'):
        (tmp_path / name).write_text('a + b\n')
    author = ['-c', 'user.name=a', '-c', 'user.email=a@example']
    for command in (['init', '-q'], ['add', '.'], [*author, 'commit', '-qm', 'first']):
        subprocess.run(['git', *command], cwd=tmp_path, check=True)
    return tmp_path


def test_the_kept_records_are_of_the_defects_in_the_lists() -> None:
    kept = json.loads(RECORDS.read_text(encoding='utf-8'))
    listed = [each for file in sorted(HERE.glob('*.yaml')) for each in read_mutants(file)]
    digests = {each.claim: digest(each) for each in listed}
    assert len(digests) == len(listed), 'each claim once'
    assert {claim: record['defect'] for claim, record in kept.items()} == digests


def test_an_outcome_is_kept_until_the_defect_changes(root: Path) -> None:
    file, first, second = root / 'records.json', mutant('first'), mutant('second')
    records = Records(file, [first, second], root)
    assert not records.has(first)
    records.keep(second, 'LIVED')
    again = Records(file, [first, second], root)
    assert again.has(second) and not again.has(first)
    record = json.loads(file.read_text(encoding='utf-8'))['second']
    assert (record['outcome'], record['date']) == ('LIVED', date.today().isoformat())
    assert record['commit'] == commit_of(root)
    assert not Records(file, [mutant('second', 'a * b')], root).has(mutant('second', 'a * b'))
    Records(file, [first], root).keep(first, 'caught')
    assert list(json.loads(file.read_text(encoding='utf-8'))) == ['first'], 'the others are gone'


def test_a_commit_with_other_code_is_marked(root: Path) -> None:
    assert len(commit_of(root)) == 10
    (root / 'docs' / 'page.md').write_text('what the run itself writes')
    assert len(commit_of(root)) == 10
    (root / 'sums.py').write_text('a - b\n')
    assert commit_of(root).endswith('-dirty')


def test_the_page_counts_by_part_and_names_what_was_not_caught() -> None:
    tried = {'commit': '0123456789', 'date': '2026-01-02'}
    tables = tables_of(
        {
            'one': {'file': FILE, 'outcome': 'caught', **tried},
            'two': {'file': FILE, 'outcome': 'LIVED', **tried},
            'three': {'file': FILE},
            'four': {'file': 'tests/bench/skeleton/rounds.py', 'outcome': 'caught', **tried},
        }
    )
    assert tables['counts'].rows == [
        ('ddct_plant/models', '3', '1', '1', '1'),
        ('tests/bench', '1', '1', '0', '0'),
        ('all', '4', '2', '1', '1'),
    ]
    assert tables['lives'].rows == [(FILE, 'two', 'LIVED')]
    assert tables['commits'].rows == [('2026-01-02', '0123456789', '3', '2')]
