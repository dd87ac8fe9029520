# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of all packaged controllers on the development cases, from the rows of the release."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.cases import Cases, packaged_folder
from ddct_bringup.benchmark.comparison import figures_of, non_dominated
from ddct_bringup.benchmark.kept_limits import limits_in
from ddct_bringup.benchmark.outcomes import Columns
from ddct_bringup.benchmark.release import ReleaseRows, release_rows
from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.campaign.rows import CRITERION
from ddct_bringup.scores.csv_text import OVER_FLOOR
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import ENGAGED
from ddct_plant.program.table import Table, Weight, with_reasons

_CASE_HEADERS = (
    *('controller', 'engaged', 'others', 'with releases', 'time to lock s'),
    *('peak jerk m/s^3', 'highest peak jerk', 'over the least', 'highest over the least'),
    *('friction work kJ', 'dominated by'),
)
_CASE_WEIGHTS = (
    *(Weight.IDENTIFYING, Weight.NEEDED, Weight.USEFUL, Weight.USEFUL, Weight.NEEDED),
    *(Weight.NEEDED, Weight.DETAIL, Weight.NEEDED, Weight.DETAIL, Weight.NEEDED, Weight.USEFUL),
)
_ALL_HEADERS = ('controller', 'engaged', 'others', 'with releases', 'limits kept', 'not dominated')
_ALL_WEIGHTS = (Weight.IDENTIFYING, Weight.NEEDED, Weight.DETAIL, Weight.USEFUL)
_MARK = 'yes'


def packaged_tables() -> Mapping[str, Table]:
    """Return a table over all cases, and one for each scenario, with a row for each controller."""
    release = release_rows(packaged_folder())
    rows = release.rows
    scenarios = Cases.packaged().whole.values_of(SCENARIO)
    tables = {
        'all': Table(
            'All development cases', _ALL_HEADERS, _overall(release), weights=_ALL_WEIGHTS
        ),
        **{name: _of_scenario(rows, name) for name in scenarios},
    }
    return {name: _complete(table) for name, table in tables.items()}


def _complete(table: Table) -> Table:
    """Return a table with the reasons of its dashes, and the option that writes all of it."""
    return replace(with_reasons(table, _dash_reason), complete='--json FILE')


def _dash_reason(header: str, row: Sequence[str]) -> str:
    """Return the reason of a dash by its column."""
    return {
        'others': 'every run is engaged',
        'limits kept': 'no limit can be kept',
    }.get(header, 'no run has a value')


def _case_cells(columns: Columns) -> tuple[str, ...]:
    """Return the cells of a controller's cases; medians and highest values are of all of them."""
    jerks, ratios = columns['peak_jerk_m_s3'], columns[f'{OVER_FLOOR}peak_jerk']
    return (
        *_counts(columns),
        _median(columns[f'{CRITERION}time_to_lock'], '.2f'),
        _median(jerks, '.1f'),
        _highest(jerks, '.1f'),
        _median(ratios, '.2f'),
        _highest(ratios, '.2f'),
        _median(1e-3 * columns['friction_energy_j'], '.1f'),
    )


def _overall(release: ReleaseRows) -> list[tuple[str, ...]]:
    rows, limits = release.rows, packaged_limits()
    best = non_dominated(rows)
    found: list[tuple[str, ...]] = []
    for name in rows.controllers:
        share = limits_in(rows, name, release.unavoidable, limits)['share']
        kept = '-' if share is None else f'{100.0 * share:.0f} %'
        chosen = _MARK if name in best else ''
        found.append((f'{name}', *_counts(rows.of(name)), kept, chosen))
    return found


def _of_scenario(rows: CaseRows, scenario: str) -> Table:
    cases = np.flatnonzero(rows.columns[SCENARIO][0] == scenario)
    chosen = rows.of_cases(cases)
    found = [(f'{name}', *_case_cells(chosen.of(name))) for name in chosen.controllers]
    dominated = dominated_by(chosen)
    return Table(
        f'Development cases of {scenario}',
        _CASE_HEADERS,
        [(*row, dominated[name]) for row, name in zip(found, chosen.controllers, strict=True)],
        weights=_CASE_WEIGHTS,
    )


def dominated_by(rows: CaseRows) -> dict[str, str]:
    """
    Return by controller the first other one that dominates it, '' for none.

    One dominates another if it is no worse, and better in one, of: share of successes, runs with
    releases, and the medians of the main quantities, where a run that fails is worse than any.
    """
    figures = {
        name: np.array([*figures_of(rows, name), _with_releases(rows.of(name))])
        for name in rows.controllers
    }
    return {
        name: next(
            (
                other
                for other, theirs in figures.items()
                if (theirs <= ours).all() and (theirs < ours).any()
            ),
            '',
        )
        for name, ours in figures.items()
    }


def _counts(columns: Columns) -> tuple[str, str, str]:
    """Return the engaged runs, the other states with their numbers, and runs with releases."""
    states = [state or 'invalid' for state in columns['verdict_state'].tolist()]
    others = Counter(state for state in states if state != ENGAGED)
    return (
        f'{states.count(ENGAGED)} of {len(states)}',
        ', '.join(f'{count} {state}' for state, count in others.most_common()) or '-',
        str(_with_releases(columns)),
    )


def _with_releases(columns: Columns) -> int:
    return int(np.nansum(columns[f'{CRITERION}releases_after_lock'] > 0.0))


def _median(values: np.ndarray, form: str) -> str:
    found = values[np.isfinite(values)]
    return format(float(np.median(found)), form) if len(found) else '-'


def _highest(values: np.ndarray, form: str) -> str:
    found = values[np.isfinite(values)]
    return format(float(found.max()), form) if len(found) else '-'
