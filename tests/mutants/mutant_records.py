# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The records of tried defects: a JSON file by claim, in the order of the lists."""

import hashlib
import json
import subprocess
from collections.abc import Sequence
from datetime import date
from pathlib import Path

from mutant_entries import Mutant

Record = dict[str, str]
"""File, digest and, once it was tried, outcome, commit and date."""


class Records:
    """Outcomes of the seeded defects in a file, which each new outcome renews."""

    def __init__(self, file: Path, mutants: Sequence[Mutant], root: Path) -> None:
        """Read what the file has, if it exists, of the `mutants` of the lists of `root`."""
        kept: dict[str, Record] = (
            json.loads(file.read_text(encoding='utf-8')) if file.exists() else {}
        )
        self._file = file
        self._tried_on = {'commit': commit_of(root), 'date': date.today().isoformat()}
        self._records: dict[str, Record] = {}
        for mutant in mutants:
            record = kept.get(mutant.claim, {})
            known = record.get('defect') == digest(mutant)
            self._records[mutant.claim] = record if known else _untried(mutant)

    def has(self, mutant: Mutant) -> bool:
        """Return whether the file has the outcome of a defect."""
        return 'outcome' in self._records.get(mutant.claim, {})

    def keep(self, mutant: Mutant, outcome: str) -> None:
        """Write the outcome of a defect at once, so that a run that is ended early has it."""
        self._records[mutant.claim] = _untried(mutant) | {'outcome': outcome} | self._tried_on
        text = json.dumps(self._records, indent=1, ensure_ascii=False)
        self._file.write_text(text + '\n', encoding='utf-8')


def digest(mutant: Mutant) -> str:
    """Return a short hash of a defect and the names of its tests."""
    facts = repr((mutant.file, mutant.find, mutant.replace, mutant.tests))
    return hashlib.sha256(facts.encode()).hexdigest()[:12]


def commit_of(root: Path) -> str:
    """Return the present commit, marked where anything but the pages differs from it."""

    def git(*words: str) -> str:
        return subprocess.run(
            ['git', *words], cwd=root, check=True, capture_output=True, text=True
        ).stdout.strip()

    changed = git('status', '--porcelain', '--untracked-files=no', '--', '.', ':!docs')
    return git('rev-parse', 'HEAD')[:10] + ('-dirty' if changed else '')


def _untried(mutant: Mutant) -> Record:
    return {'file': mutant.file, 'defect': digest(mutant)}
