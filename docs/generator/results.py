# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Results in the sentences of the pages: computed ones by name, and repeated cells of tables.

A result is between `<!-- result: NAME -->` and `<!-- end -->`, on README or a page of docs, and
may be there several times. Results follow from tables that the pages show and from runs of the
thesis's scenario, so `make docs KINDS=results` comes after the other kinds. It writes the cells
of `cells.py` too.
"""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from ddct_bringup.metrics.catalogue import CRITERIA
from ddct_bringup.reproduction.study_run import thesis_run
from ddct_bringup.thesis.table_5_1 import ROW_OF, TABLE_METRICS
from ddct_bringup.verdict.state import ENGAGED, INVALID, NOT_ENGAGED
from ddct_controllers.registry import own_controller_names
from ddct_plant.base.errors import DdctError
from ddct_plant.program.table import UNDEFINED
from generator.cells import fill_cells
from generator.pages import DOCS, rows_of, shown_tables
from generator.robustness.robustness_map import kept_maps

HOLDS = ': holds'
"""End of a word of Table 5.2 that our runs confirm."""
_WORN = '1.3'
_SHORT = dict(zip(TABLE_METRICS, ('t_a', 'w_sr', 'a_x'), strict=True))
_FORMS = dict(zip(TABLE_METRICS, ('.2f', '.2f', '.3f'), strict=True))
_SHIFT_TIME, _JERK = 'shift time s', 'peak jerk m/s^3'
_LEAST, _OVER = 'least jerk m/s^3', 'jerk /least'
"""Headings of columns of the tables of gear shifts."""
_PAIR = 'torque_estimator'
"""Controller that shifts fast without much jerk with the handover `model`."""
_QUICK_S = 0.7
"""Shift time in s below which a shift counts as quick in a sentence."""
_MARKED = re.compile(r'(<!-- result: (\w+) -->)(.*?)(<!-- end -->)', re.DOTALL)
PAGES = (DOCS.parent / 'README.md', *sorted(DOCS.rglob('*.md')))


def marked_results(page: Path) -> list[tuple[str, str]]:
    """Return name and text of each result on a page, in their order."""
    return [(match[2], match[3]) for match in _MARKED.finditer(page.read_text(encoding='utf-8'))]


def fill_results(computed: Mapping[str, str]) -> list[Path]:
    """
    Write the results and repeated cells into all pages and return those that have changed.

    Raise DdctError for a name that nothing computes, and for a cell that no table has.
    """
    names = {name for page in PAGES for name, _ in marked_results(page)}
    if unknown := sorted(names - set(computed)):
        raise DdctError(f'the pages have the result {unknown[0]}: known: {", ".join(computed)}')
    changed = []
    for page in PAGES:
        old = page.read_text(encoding='utf-8')
        new = _MARKED.sub(lambda match: f'{match[1]}{computed[match[2]]}{match[4]}', old)
        if new != old:
            page.write_text(new, encoding='utf-8')
        if fill_cells(page) or new != old:
            changed.append(page)
    return changed


def results() -> Mapping[str, str]:
    """Return the text of each result by name."""
    return {
        'controllers': str(len(own_controller_names())),
        'criteria': str(len(CRITERIA)),
        'diverged_runs': str(int(np.sum(kept_maps()['delay'].states == INVALID))),
        **_thesis_numbers(),
        **_table_5_2(),
        **_engagements(),
        **_table_5_1(),
        **_shifts(),
    }


def _thesis_numbers() -> dict[str, str]:
    """Return the counts of the list of numbers: entries, and facts by verdict."""
    counts = {row[0]: row[1:] for row in rows_of(shown_tables('numbers')['facts'])}
    facts = {verdict: int(count) for verdict, (_, count) in counts.items()}
    fits = facts['calibrated hit'], facts['calibrated miss']
    predictions = facts['predicted hit'], facts['predicted miss']
    return {
        'gate_entries': counts['all'][0],
        'gate_facts': counts['all'][1],
        'gate_reproduced': str(facts['reproduced']),
        'gate_errata': str(facts['erratum']),
        'gate_fits': f'{fits[0]} of {sum(fits)}',
        'gate_predictions': f'{predictions[0]} of {sum(predictions)}',
    }


def _table_5_2() -> dict[str, str]:
    """Return how many of the words of Table 5.2 hold with each clutch."""
    rows = rows_of(shown_tables('studies')['table_5_2_in_numbers'])
    held = {}
    for clutch in ('linear', 'stick_slip'):
        words = [word for row in rows if row[0] == clutch for word in row[-2:] if word != '-']
        holding = sum(word.endswith(HOLDS) for word in words)
        held[f'table_5_2_{clutch}'] = f'{holding} of the {len(words)}'
    return held


def _engagements() -> dict[str, str]:
    """Return how many controllers engage, or do not, in `thesis` with the clutch at wear 1.3."""
    tables = shown_tables('studies')
    states = {
        clutch: [
            row[2] for row in rows_of(tables[f'engagements_thesis_{clutch}']) if row[0] == _WORN
        ]
        for clutch in ('linear', 'stick_slip')
    }
    sticking = states['stick_slip']
    return {
        'engaged_sticking': f'{sticking.count(ENGAGED)} of {len(sticking)}',
        'not_engaged_linear': str(states['linear'].count(NOT_ENGAGED)),
    }


def _table_5_1() -> dict[str, str]:
    """Return values of PI, MPC3 and MPC4 in `thesis`, and deviations from the print in %."""
    texts = {}
    for controller in ('pi', 'mpc3', 'mpc4'):
        printed = ROW_OF[controller].printed_values()
        for metric, value in thesis_run(controller, 'detailed', 1.0).table_values.items():
            if value is not None:
                name = f'{controller}_{_SHORT[metric]}'
                texts[name] = f'{value:{_FORMS[metric]}}'
                texts[f'{name}_off'] = f'{abs(100.0 * (value / printed[metric] - 1.0)):.0f} %'
    return texts


def _shifts() -> dict[str, str]:
    """Return what the table of all controllers in a gear shift shows."""
    table = shown_tables('shifts')['controllers']
    headers = tuple(table.splitlines()[0][2:-2].split(' | '))
    rows = [dict(zip(headers, row, strict=True)) for row in rows_of(table)]
    engaged = [row for row in rows if row['state'] == ENGAGED]
    of_thesis = [row for row in engaged if row['controller'] in ROW_OF]
    times, jerks = ([float(row[name]) for row in engaged] for name in (_SHIFT_TIME, _JERK))
    quick = [row for row in engaged if float(row[_SHIFT_TIME]) < _QUICK_S]
    return {
        'shifts_engaged': f'{len(engaged)} of {len(rows)}',
        'shifts_failed': ', '.join(f'`{row["controller"]}`' for row in rows if row not in engaged),
        'shifts_dip': _between([float(row['torque dip %']) for row in of_thesis], '.0f'),
        'shifts_times': _between(times, '.2f'),
        'shifts_jerks': _between(jerks, '.0f'),
        'shifts_quick': ', '.join(map(_time_and_jerk, quick)) or 'none',
        'shifts_quick_flare': f'{max(float(row["flare rad/s"]) for row in quick):.1f}',
        'shifts_quick_tie_up': f'{max(float(row["tie-up J"]) for row in quick):.0f}',
        'shifts_nearest': _nearest(engaged),
        'shifts_quick_nearest': _nearest(quick),
        **_pair(rows),
        'shifts_hot_tie_up': _between(_tie_ups_of('upshift_hot'), '.0f'),
        'shifts_quickest': _time_and_jerk(min(of_thesis, key=lambda row: float(row[_SHIFT_TIME]))),
        'shifts_smoothest': _time_and_jerk(min(of_thesis, key=lambda row: float(row[_JERK]))),
    }


def _tie_ups_of(scenario: str) -> list[float]:
    """Return the tie-up work in J of the runs of a scenario in the table of shifts."""
    table = shown_tables('shifts')['scenarios']
    column = table.splitlines()[0][2:-2].split(' | ').index('tie-up J')
    return [float(row[column]) for row in rows_of(table) if row[0].startswith(f'`{scenario}`')]


def _nearest(rows: Sequence[Mapping[str, str]]) -> str:
    """Return the controller whose peak jerk is nearest to the least, with the ratio."""
    nearest = min(
        (row for row in rows if row[_OVER] != UNDEFINED), key=lambda row: float(row[_OVER])
    )
    return f'`{nearest["controller"]}` ({nearest[_OVER]})'


def _pair(rows: Sequence[Mapping[str, str]]) -> dict[str, str]:
    """Return the peak jerk of the pair that shifts fast without much of it, beside the least."""
    (row,) = (row for row in rows if row['controller'] == _PAIR)
    return {'shifts_pair_jerk': row[_JERK], 'shifts_pair_least': row[_LEAST]}


def _between(values: Sequence[float], form: str) -> str:
    return f'{min(values):{form}} to {max(values):{form}}'


def _time_and_jerk(row: Mapping[str, str]) -> str:
    return f'`{row["controller"]}` ({row[_SHIFT_TIME]} s, {row[_JERK]} m/s³)'
