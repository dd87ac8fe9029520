# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of docs/thesis/robustness_map.md."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import product

from ddct_bringup.reproduction.values.orders import SLIP_RATINGS, WORN
from ddct_bringup.verdict.state import ENGAGED, INVALID, NEARLY_ENGAGED, RUNAWAY
from ddct_plant.program.table import UNDEFINED, Table
from generator.robustness.robustness_map import ARCHITECTURE, WEAR, StateMap

NOMINAL_DELAY_S = 0.01
PLANTS = {'linear': 'linear', 'stick_slip': 'stick-slip'}
"""Name of the plant in the pages, by clutch."""


def robustness_tables(maps: Mapping[str, StateMap]) -> dict[str, Table]:
    """Return the tables by name."""
    delay, mass = maps['delay'], maps['mass']
    return {
        'wear': _wear_table(delay),
        'delay': _ranges_table(
            delay, [f'{1e3 * each:g} ms' for each in delay.values(delay.third)]
        ),
        'mass': _ranges_table(mass, [f'{each:g} kg' for each in mass.values(mass.third)]),
        'jerk': _jerk_table(delay),
        'share': _share_table(delay),
    }


def ranges_text(values: Sequence[float], states: Iterable[str]) -> str:
    """Return the ranges with engaged runs: `0.7 to 1.1`, separated by commas, a dash for none."""
    parts: list[list[float]] = []
    before = ''
    for value, state in zip(values, states, strict=True):
        if state == ENGAGED:
            parts = [*parts[:-1], [*parts[-1], value]] if before == ENGAGED else [*parts, [value]]
        before = state
    texts = [' to '.join(f'{end:g}' for end in dict.fromkeys((p[0], p[-1]))) for p in parts]
    return ', '.join(texts) or UNDEFINED


def _wear_table(found: StateMap) -> Table:
    """Return the states at the wear gains of Table 5.2, and the engaged range around 1."""
    wears = found.values(WEAR)
    rows = []
    for architecture, name in product(found.values(ARCHITECTURE), found.spec.controllers):
        cells = []
        for clutch in PLANTS:
            line = found.line(name, architecture, clutch, NOMINAL_DELAY_S)
            cells += [ranges_text(wears, line), *(_state_text(line[wears.index(w)]) for w in WORN)]
        rows.append((architecture, name, *cells, SLIP_RATINGS.get(name, UNDEFINED)))
    headers = [
        heading
        for plant in PLANTS.values()
        for heading in (f'{plant}: engaged at wear gain', *(f'{plant}, {w:g}' for w in WORN))
    ]
    return Table('', (ARCHITECTURE, 'controller', *headers, 'Table 5.2, w_d'), rows)


def _ranges_table(found: StateMap, headers: Sequence[str]) -> Table:
    """Return the wear gains with engaged runs by the third value."""
    wears = found.values(WEAR)
    rows = [
        (
            architecture,
            PLANTS[clutch],
            name,
            *(ranges_text(wears, line) for line in found.plane(name, architecture, clutch)),
        )
        for architecture, clutch, name in _loops(found)
    ]
    return Table('', (ARCHITECTURE, 'plant', 'controller', *headers), rows)


def _jerk_table(found: StateMap) -> Table:
    """Return the peak jerk at wear gain 1, in brackets where the run is not engaged."""
    delays = found.values(found.third)
    rows = []
    for architecture, clutch, name in _loops(found):
        cells = []
        for delay in delays:
            point = (architecture, clutch, delay)
            state = found.line(name, *point)[found.values(WEAR).index(1.0)]
            cells.append(_jerk_text(found.jerk_at(name, *point, 1.0), state))
        rows.append((architecture, PLANTS[clutch], name, *cells))
    headers = [f'{1e3 * delay:g} ms' for delay in delays]
    return Table('', (ARCHITECTURE, 'plant', 'controller', *headers), rows)


def _jerk_text(jerk: float, state: str) -> str:
    if not math.isfinite(jerk):
        return UNDEFINED
    text = f'{jerk:.1f}' if jerk < 1000.0 else f'{jerk:.0e}'
    return text if state == ENGAGED else f'({text})'


def _share_table(found: StateMap) -> Table:
    """Return the share of runs of the map by final state, in percent."""
    rows = []
    for architecture, clutch, name in _loops(found):
        states = [state for line in found.plane(name, architecture, clutch) for state in line]
        engaged, nearly, driven_apart = (
            sum(state in those for state in states)
            for those in ((ENGAGED,), (NEARLY_ENGAGED,), (RUNAWAY, INVALID))
        )
        others = len(states) - engaged - nearly - driven_apart
        counts = (engaged, nearly, others, driven_apart)
        shares = (f'{100.0 * count / len(states):.0f}' for count in counts)
        rows.append((architecture, PLANTS[clutch], name, *shares))
    headers = (
        'engaged %',
        'nearly engaged %',
        'not engaged or oscillating %',
        'runaway or invalid %',
    )
    return Table('', (ARCHITECTURE, 'plant', 'controller', *headers), rows)


def _loops(found: StateMap) -> Iterator[tuple[str, str, str]]:
    yield from product(found.values(ARCHITECTURE), PLANTS, found.spec.controllers)


def _state_text(state: str) -> str:
    return state.replace('_', ' ')
