# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Record of `make soak`: the tables and the chart of docs/use/real_time.md."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.program.table import UNDEFINED, Table
from ddct_plant.ticks.durations import DurationHistogram, checked, upper_end_us
from generator.pages import DOCS

RECORD = DOCS / 'use' / 'real_time.json'
"""Record that `make soak` writes."""
_TICKS_MS = (1, 2, 5, 10, 20, 50, 100, 200)
PERCENTS = (50.0, 99.0, 99.9, 100.0)
SIDES = {'graph': 'the graph', 'chain': 'the bare chain'}
DURATIONS = ('latency', 'lateness', 'jitter')
Record = Mapping[str, Any]


def record_of(file: Path = RECORD) -> Record:
    """Return the record."""
    return json.loads(file.read_text(encoding='utf-8'))


def digest_of_record(file: Path = RECORD) -> str:
    """Return a hash of the record."""
    return hashlib.sha256(file.read_bytes()).hexdigest()


def histogram_of(side: Record, duration: str) -> DurationHistogram:
    """Return the histogram of a duration of one side."""
    values = side['durations'][duration]
    counts = {int(place): count for place, count in values['counts'].items()}
    return checked(values['largest_us'], counts)


def soak_tables(record: Record) -> Mapping[str, Table]:
    """Return the tables of the machine, of misses and durations, and of what processes use."""
    return {
        'machine': _machine(record),
        'durations': _durations(record['measured']),
        'nodes': _nodes(record['measured']),
    }


def _machine(record: Record) -> Table:
    machine = record['machine']
    packages = machine['packages']
    rows = [
        ('processor', f'{machine["processor"]}, {machine["cores"]} cores'),
        ('kernel', machine['kernel']),
        ('versions', f'Python {machine["python"]}, rclpy {packages["rclpy"]}'),
    ]
    for measured in record['measured']:
        commit = measured['commit'] + (' and changes' if measured['changed'] else '')
        minutes = measured['sides']['graph']['steps'] * PERIOD_S / 60.0
        text = (
            f'{minutes:g} minutes, {measured["time"]}, commit {commit}; load '
            f'{measured["load_before"]:g} in the minute before; meanwhile programs that the '
            f'measurement did not start used {measured["other_cores"]:.2f} cores, and the host '
            f'took {measured["stolen_cores"]:.4f} cores'
        )
        rows.append((measured['what'], text))
    return Table('', ('', 'what it was'), rows)


def _durations(measured: Sequence[Record]) -> Table:
    headers = ('condition', 'side', 'missed', 'duration', 'p50', 'p99', 'p99.9', 'max')
    rows = []
    for each in measured:
        for side, name in SIDES.items():
            found = each['sides'][side]
            for duration in DURATIONS:
                histogram = histogram_of(found, duration)
                ends = [histogram.percentile_us(percent) for percent in PERCENTS]
                missed = f'{found["missed_steps"]} of {found["steps"]}'
                texts = [UNDEFINED if us is None else f'{us / 1e3:.2f}' for us in ends]
                rows.append((each['what'], name, missed, f'{duration} in ms', *texts))
    return Table('', headers, rows)


def _nodes(measured: Sequence[Record]) -> Table:
    headers = ['process']
    for each in measured:
        headers += [f'{each["what"]}: % of a core', 'memory in MB', 'growth in MB']
    rows = []
    for name in measured[0]['nodes']:
        row = [name]
        for each in measured:
            use = each['nodes'][name]
            row += [f'{100.0 * use["core_share"]:.1f}', f'{use["memory_mb"]:.0f}']
            row.append(f'{use["growth_mb"]:.1f}')
        rows.append(row)
    return Table('', headers, rows)


def soak_figure(record: Record) -> Figure:
    """Return a panel for each condition: the share of ticks with at least a latency."""
    measured = record['measured']
    figure = Figure(figsize=(5.0 * len(measured), 4.2), layout='constrained')
    figure.suptitle('Share of ticks whose latency is longer')
    panels = figure.subplots(1, len(measured), squeeze=False, sharex=True, sharey=True).flat
    for axes, each in zip(panels, measured, strict=True):
        _draw(axes, each)
    return figure


def _draw(axes: Axes, measured: Record) -> None:
    for side, name in SIDES.items():
        histogram = histogram_of(measured['sides'][side], 'latency')
        places = sorted(histogram.counts)
        longer = histogram.total - np.cumsum([histogram.counts[place] for place in places])
        ends_ms = [upper_end_us(place) / 1e3 for place in places]
        axes.step(ends_ms[:-1], longer[:-1] / histogram.total, where='post', label=name)
    axes.axvline(10.0, color='0.5', linestyle=':', label='period')
    axes.set_xscale('log')
    axes.set_yscale('log')
    axes.set_xticks(_TICKS_MS, [f'{tick}' for tick in _TICKS_MS])
    axes.minorticks_off()
    axes.set_xlabel('latency in ms')
    axes.set_title(measured['what'], fontsize='medium')
    axes.legend()
