# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Which tests run a line, out of the records of `tracing.py`; processes of a test count as it."""

import json
import sqlite3
from collections import defaultdict
from pathlib import Path

from coverage.numbits import numbits_to_nums

from mutation.plugin import SETUP

_QUERY = (
    'select path, context, numbits from line_bits join file on file.id = file_id'
    ' join context on context.id = context_id'
)


class CoverageMap:
    """Tests by product line, and their durations."""

    def __init__(self, folder: Path, root: Path) -> None:
        """Read the records in `folder` of the copy at `root`."""
        self.durations_s: dict[str, float] = defaultdict(float)
        """Time of each test with its fixtures, s."""
        self.outcomes: dict[str, str] = {}
        """`passed`, `failed` or `skipped`, by test."""
        self._graph: set[str] = set()
        self._read_durations(folder / 'durations.jsonl')
        self._by_file: dict[str, list[str]] = defaultdict(list)
        for test in self.durations_s:
            self._by_file[test.partition('::')[0]].append(test)
        self._lines: dict[str, dict[int, set[str]]] = defaultdict(lambda: defaultdict(set))
        self._prefix = f'{root}/'
        for record in folder.iterdir():
            if not record.suffix:
                self._read(record)

    def _read_durations(self, file: Path) -> None:
        for line in file.read_text(encoding='utf-8').splitlines():
            test, outcome, duration_s, graph = json.loads(line)
            if graph:
                self._graph.add(test)
            self.durations_s[test] += duration_s
            if outcome != 'passed' or test not in self.outcomes:
                self.outcomes[test] = outcome

    def _read(self, record: Path) -> None:
        beside = record.with_suffix('.test')
        of_process = beside.read_text(encoding='utf-8') if beside.exists() else ''
        if not of_process.endswith(SETUP):
            of_process = of_process.rpartition(' (')[0]  # the phase of its call or its end
        connection = sqlite3.connect(record)
        try:
            rows = connection.execute(_QUERY).fetchall()
        except sqlite3.DatabaseError:  # its process was killed while it wrote
            return
        finally:
            connection.close()
        for path, context, bits in rows:
            if not path.startswith(self._prefix):
                continue
            of_file = self._lines[path.removeprefix(self._prefix)]
            for line in numbits_to_nums(bits):
                of_file[line].add(context or of_process)

    def tests_of(self, file: str, line: int) -> list[str]:
        """
        Return the tests that run a line, those of least duration first.

        A line that runs in a fixture is run by all tests of that file, as one of them may be made
        for all. A line that only imports run is run by all tests that run some line of its file.
        """
        of_file = self._lines.get(file, {})
        contexts = {each for each in of_file.get(line, ()) if each}
        if not contexts and line in of_file:
            contexts = {each for found in of_file.values() for each in found if each}
        tests: set[str] = set()
        for context in contexts:
            test = context.removesuffix(SETUP)
            tests.update(self._by_file[test.partition('::')[0]] if test != context else [test])
        usable = [test for test in tests if self.outcomes.get(test) == 'passed']
        return sorted(usable, key=lambda test: (self.durations_s[test], test))

    def only_a_graph(self, file: str, line: int) -> bool:
        """Return whether tests run a line, and all of them start nodes or programs."""
        tests = self.tests_of(file, line)
        return bool(tests) and self._graph.issuperset(tests)
