# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of many runs: the columns that they share, their notes, and their width."""

import io
import re

import pytest
from made_scores import made_scores as run
from printed_table import value_under

from ddct_bringup.scores.run_table import (
    FIGURE_COLUMNS,
    RunColumn,
    figure_columns,
    identifying_columns,
    print_runs,
)
from ddct_bringup.scores.scored_run import ScoredRun

STICKING: dict[str, float | None] = {
    'time_to_final_lock_s': 1.123,
    'torque_late_s': 0.104,
    'peak_jerk_m_s3': 11.34,
    'peak_jerk_over_least': 2.31,
    'friction_work_j': 7712.0,
    'weighted_acceleration_m_s2': 0.967,
    'releases': 3,
}
"""Figures of a run whose plates can lock."""
LINEAR = {
    **STICKING,
    **dict.fromkeys(('time_to_final_lock_s', 'releases', 'peak_jerk_over_least')),
    'engagement_time_s': 0.8804,
    'torsion_speed_std_rpm': 0.7049,
    'acceleration_std_m_s2': 0.1806,
    'slip_final_rpm': -18.34,
}
SHIFT = {**STICKING, 'torque_dip_percent': 41.6, 'flare_rad_s': 3.21, 'tie_up_work_j': 12.6}


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def printed(runs: list[ScoredRun], stream: io.StringIO | None = None, notes: tuple = ()) -> str:
    stream = stream or io.StringIO()
    columns = (*identifying_columns(runs), *figure_columns(runs))
    print_runs(runs, columns, stream, notes=notes)
    return re.sub(r'\x1b\[[0-9;]*m', '', stream.getvalue())


def on_terminal(runs: list[ScoredRun], monkeypatch: pytest.MonkeyPatch, columns: int = 80) -> str:
    monkeypatch.setenv('COLUMNS', str(columns))
    monkeypatch.setenv('TERM', 'xterm-256color')
    return printed(runs, Terminal())


def headings_of(columns: tuple[RunColumn, ...]) -> list[str]:
    return [' '.join(column.heading.split()) for column in columns]


def test_the_absolute_jerk_is_beside_its_ratio_and_the_state_last() -> None:
    assert headings_of(figure_columns([run(**STICKING)])) == [
        *('lock s', 'late s', 'jerk m/s^3', 'jerk /least', 'least m/s^3'),
        *('work kJ', 'A_w m/s^2', 're- leases', 'state'),
    ]


def test_one_run_that_sticks_gives_linear_runs_its_columns() -> None:
    sticking = figure_columns([run(**STICKING)])
    assert figure_columns([run(**LINEAR), run(**STICKING)]) == sticking
    assert figure_columns([run(**LINEAR)]) != sticking


def test_runs_of_which_none_is_valid_have_the_columns_of_plates_that_can_lock() -> None:
    failed = run(valid=False, reason='x', state='invalid')
    assert figure_columns([failed]) == figure_columns([run(**STICKING)])
    assert figure_columns([failed, run(**LINEAR)]) == figure_columns([run(**LINEAR)])


def test_one_shift_gives_all_runs_the_columns_of_a_shift() -> None:
    of_shift = {FIGURE_COLUMNS[key] for key in SHIFT.keys() - STICKING.keys()}
    assert of_shift < set(figure_columns([run(**SHIFT), run(**STICKING)]))
    assert not of_shift & set(figure_columns([run(**STICKING)]))


def test_runs_without_a_value_for_other_reasons_have_other_dashes() -> None:
    without = {**STICKING, 'peak_jerk_over_least': None}
    reasons = {'pi': 'no floor', 'ls8': 'not asked for', 'mpc3': 'no floor'}
    text = printed(
        [
            run(name, null_reasons={'peak_jerk_over_least': reason}, **without)
            for name, reason in reasons.items()
        ]
    )
    assert text.count('no floor') == text.count('not asked for') == 1
    shown = {name: value_under(text, 'jerk', name, place=1)[1] for name in reasons}
    assert shown == {'pi': '-', 'ls8': '--', 'mpc3': '-'}


def test_only_the_run_whose_least_is_no_bound_has_a_star() -> None:
    runs = [run('pi', least_is_bound=True, **STICKING), run('ls8', **STICKING)]
    why = {'least_is_bound': 'slips again'}
    text = printed([*runs, run('mpc4', least_is_bound=False, null_reasons=why, **STICKING)])
    assert [line.split()[0] for line in text.splitlines() if '2.3*' in line] == ['mpc4']


def test_a_note_has_the_bag_and_further_notes_come_after_those_of_runs() -> None:
    runs = [run('ls8', bag='runs/a', state='late', why='short', **STICKING), run(**STICKING)]
    assert '\n  runs/a: late: short\n  a further note\n' in printed(
        runs, notes=('a further note',)
    )


def test_a_valid_run_with_steps_without_a_solution_has_a_note() -> None:
    steps = {'fallbacks': 3, 'steps': 300}
    assert 'pi: at 3 of 300 steps its program had no solution' in printed([run(**steps)])
    failed = run(**steps, valid=False, reason='x', state='invalid')
    assert 'no solution' not in printed([failed])


def test_the_log_of_another_tool_is_never_too_slow() -> None:
    times = {'update_time_median_us': 8e3, 'update_time_p99_us': 2e4}
    assert 'too slow' not in printed([run(mode='measured', **times)])
    assert 'too slow' in printed([run(mode='realtime', **times)])


def test_at_most_six_lines_are_below_a_table_and_the_others_are_counted() -> None:
    runs = [run(str(number), state='late', why='short', **STICKING) for number in range(8)]
    lines = printed(runs, notes=('last',)).rstrip().splitlines()
    below = lines[lines.index('  0: late: short') :]
    assert len(below) == 6
    assert below[-1] == '  4 more notes, with --json FILE'


@pytest.mark.parametrize('mode', ['lockstep', 'realtime'])
@pytest.mark.parametrize('figures', [STICKING, LINEAR, SHIFT], ids=['sticks', 'linear', 'shift'])
def test_no_line_is_wider_than_a_terminal_of_80_columns_or_120_elsewhere(
    figures: dict[str, float | None], mode: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    realtime = {'missed_steps': 7, 'worst_lateness_us': 1234.5, 'safe_state': 'actuator at 0.9 s'}
    more = {**figures, **(realtime if mode == 'realtime' else {})}
    runs = [
        run(name, mode=mode, state='not_engaged', why='word ' * 40, **more)
        for name in ('torque_estimator', 'ls8')
    ]
    assert max(map(len, on_terminal(runs, monkeypatch).splitlines())) <= 80
    assert max(map(len, printed(runs).splitlines())) <= 120


def test_a_narrow_terminal_shows_the_needed_columns_and_names_the_others(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    text = on_terminal([run('torque_estimator', **SHIFT)], monkeypatch)
    rows = ' '.join(line for line in text.splitlines() if 'torque_estimator' in line)
    assert {'1.12', '0.10', '11.3', '2.3', '7.7', '0.97', '3', 'engaged'} <= set(rows.split())
    hidden = 'wear, least m/s^3, dip %, flare rad/s, tie-up J'
    assert f'  not shown: {hidden}; all with --json\n' in text
    assert 'not shown' not in on_terminal([run('torque_estimator', **SHIFT)], monkeypatch, 140)


def test_the_useful_dip_is_left_out_after_the_details_of_a_shift(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    text = on_terminal([run('ls8', **SHIFT)], monkeypatch, 85)
    assert '  not shown: least m/s^3, flare rad/s, tie-up J; all with' in text
