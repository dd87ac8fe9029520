# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Read the seeded defects: each names a file, an exact text of it, the defect and its tests."""

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import yaml


@dataclass(frozen=True)
class Mutant:
    """One seeded defect; every test that claims its behaviour must fail with it."""

    claim: str
    """What the code would do with the defect."""
    file: str
    """The changed file, relative to the repository."""
    find: str
    """Text that occurs exactly once in the file."""
    replace: str
    """The defect that takes its place."""
    tests: tuple[str, ...]
    """Arguments of pytest, relative to the repository: the cheapest that catch the defect."""

    def defective(self, root: Path) -> str:
        """Return the text of the file with the defect; raise ValueError for a stale entry."""
        path = root / self.file
        if not path.is_file():
            raise ValueError(f'{self.claim}: there is no file {self.file}')
        text = path.read_text(encoding='utf-8')
        if (times := text.count(self.find)) != 1:
            raise ValueError(f'{self.claim}: `find` occurs {times} times in {self.file}, not once')
        if self.find == self.replace:
            raise ValueError(f'{self.claim}: `find` and `replace` are the same')
        for test in self.tests:
            if not _exists(root, test):
                raise ValueError(f'{self.claim}: there is no test {test}')
        return text.replace(self.find, self.replace)


def _exists(root: Path, test: str) -> bool:
    """Return whether an argument of pytest, FILE or FILE::FUNCTION[PARAMETERS], names a test."""
    file, _, function = test.partition('::')
    name = function.partition('[')[0]
    path = root / file
    return path.exists() and (not name or f'\ndef {name}(' in path.read_text(encoding='utf-8'))


def read_mutants(file: Path) -> list[Mutant]:
    """Return the entries of a YAML file; raise ValueError for a missing or an unknown key."""
    content = yaml.safe_load(file.read_text(encoding='utf-8'))
    if not isinstance(content, list):
        raise ValueError(f'{file.name}: must be a list of entries')
    return [_mutant(entry, f'{file.name}: entry {i}') for i, entry in enumerate(content, start=1)]


def _mutant(entry: Any, where: str) -> Mutant:
    keys = [field.name for field in fields(Mutant)]
    if not isinstance(entry, dict) or set(entry) != set(keys):
        raise ValueError(f'{where}: must have exactly the keys {", ".join(keys)}')
    texts, tests = [entry[key] for key in keys[:-1]], entry['tests']
    if not all(isinstance(text, str) for text in texts):
        raise ValueError(f'{where}: {", ".join(keys[:-1])} must be texts')
    if not (isinstance(tests, list) and tests and all(isinstance(test, str) for test in tests)):
        raise ValueError(f'{where}: tests must be a list of one or more arguments of pytest')
    return Mutant(**{**entry, 'tests': tuple(tests)})
