# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""History of `make bench`: the figures of each kind of machine, and the tables of the page."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ddct_plant.program.table import UNDEFINED, Table
from generator.pages import DOCS

HISTORY = DOCS / 'develop' / 'speed'
"""Folder of the files `KIND.jsonl`, one record of a bench a line."""
Key = tuple[str, str]
"""Name and reference of a figure."""


@dataclass(frozen=True)
class MachineHistory:
    """Records of one kind of machine, oldest first."""

    letter: str
    """Letter that stands for the kind of machine in tables and charts."""
    records: Sequence[Mapping[str, Any]]

    @property
    def newest(self) -> Mapping[Key, Mapping[str, Any]]:
        """Newest figure with ratios of each name and reference."""
        return {
            (figure['name'], figure['reference']): figure
            for record in self.records
            for figure in record['figures']
            if 'ratio' in figure
        }

    def curve(self, abscissa: str) -> dict[str, list[tuple[float, float, float, float]]]:
        """Return by curve its points: abscissa, median, smallest and largest ratio."""
        curves: dict[str, list[tuple[float, float, float, float]]] = {}
        for (name, _), figure in self.newest.items():
            if abscissa in figure.get('over', {}):
                rounds = figure['rounds']
                point = (figure['over'][abscissa], figure['ratio'], min(rounds), max(rounds))
                curves.setdefault(name.rpartition(f', {abscissa} ')[0], []).append(point)
        return {name: sorted(points) for name, points in curves.items()}


def histories(folder: Path = HISTORY) -> list[MachineHistory]:
    """Return the history of each kind of machine."""
    files = sorted(folder.glob('*.jsonl'))
    texts = [file.read_text(encoding='utf-8').splitlines() for file in files]
    return [
        MachineHistory(chr(ord('A') + number), [json.loads(line) for line in lines])
        for number, lines in enumerate(texts)
    ]


def digest_of(folder: Path = HISTORY) -> str:
    """Return a hash of the history."""
    files = sorted(folder.glob('*.jsonl'))
    return hashlib.sha256(b''.join(file.read_bytes() for file in files)).hexdigest()


def speed_tables(machines: Sequence[MachineHistory]) -> Mapping[str, Table]:
    """Return the tables of machines, of figures with a bound, and of all other figures."""
    return {
        'machines': _machine_table(machines),
        'bounded': _figure_table(machines, bounded=True),
        'reported': _figure_table(machines, bounded=False),
    }


def _machine_table(machines: Sequence[MachineHistory]) -> Table:
    headers = (
        '',
        'processor',
        'cores',
        'Python',
        'packages',
        'records',
        'newest',
        'commit',
        'load',
    )
    rows = []
    for machine in machines:
        newest = machine.records[-1]
        kind = newest['machine']
        packages = ', '.join(f'{name} {version}' for name, version in kind['packages'].items())
        commit = newest['commit'] + (' and changes' if newest['changed'] else '')
        rows.append(
            [
                machine.letter,
                kind['processor'],
                str(kind['cores']),
                kind['python'],
                packages,
                str(len(machine.records)),
                newest['time'],
                commit,
                str(newest['load']),
            ]
        )
    return Table('Kinds of machines', headers, rows)


def _figure_table(machines: Sequence[MachineHistory], *, bounded: bool) -> Table:
    """Return a row for each figure without those of curves, which the charts show."""
    keys = dict.fromkeys(
        (reference, name)
        for machine in machines
        for (name, reference), figure in machine.newest.items()
        if (figure['bound'] is not None) == bounded and 'over' not in figure
    )
    headers = ['figure', 'beside', *(['at most'] if bounded else [])]
    rows = []
    for reference, name in keys:
        found = [machine.newest.get((name, reference)) for machine in machines]
        bounds = [f'{figure["bound"]:.3g}' for figure in found if figure and bounded][:1]
        rows.append([name, reference, *bounds, *(_spread(figure) for figure in found)])
    return Table('Figures', [*headers, *(machine.letter for machine in machines)], rows)


def _spread(figure: Mapping[str, Any] | None) -> str:
    if figure is None:
        return UNDEFINED
    least, most = min(figure['rounds']), max(figure['rounds'])
    return f'{figure["ratio"]:.3g} ({least:.3g} to {most:.3g})'
