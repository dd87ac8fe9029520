# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of runs on terminals, in pipes, and without colours."""

import io
import re

import pytest
from made_scores import made_scores as run
from printed_table import value_under

from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.scores.run_table import (
    BAG,
    CONTROLLER,
    YARDSTICK,
    figure_columns,
    metric,
    print_runs,
)
from ddct_plant.program.table import TextColumn
from ddct_plant.signals.gain_changes import GainChange


class Terminal(io.StringIO):
    def isatty(self):
        return True


def unwrapped(text):
    """Return a text with the lines of a note joined; a word that is wider has no space within."""
    joined = re.sub(r'(?<=x)\n +(?=x)', '', text)
    return re.sub(r'\n  +', ' ', joined)


def printed(runs, first=(CONTROLLER,), stream=None):
    stream = stream or io.StringIO()
    print_runs(runs, (*first, *figure_columns(runs)), stream)
    return stream.getvalue()


STICKING = {'time_to_final_lock_s': 1.0, 'releases': 0}
"""Figures that tell plates that can lock from a linear clutch."""


@pytest.mark.parametrize(
    ('heading', 'unit', 'metric_name', 'value', 'shown'),
    [
        ('lock', 's', 'time_to_final_lock_s', 0.88, '0.88'),
        ('late', 's', 'torque_late_s', 0.104, '0.10'),
        ('jerk', 'm/s^3', 'peak_jerk_m_s3', 12.345, '12.3'),
        ('jerk', '/least', 'peak_jerk_over_least', 1.26, '1.3'),
        ('work', 'kJ', 'friction_work_j', 5312.0, '5.3'),
        ('A_w', 'm/s^2', 'weighted_acceleration_m_s2', 0.774, '0.77'),
        ('re-', 'leases', 'releases', 3, '3'),
    ],
)
def test_a_figure_is_below_its_heading_and_unit(heading, unit, metric_name, value, shown):
    others = {key: None if each.of_shift else 1000.0 for key, each in METRICS.items()}
    text = printed([run(**{**others, metric_name: value})])
    place = 1 if unit == '/least' else 0
    assert value_under(text, heading, 'pi', place) == (unit, shown)


def test_a_linear_clutch_has_the_columns_of_table_5_1_in_place_of_those_of_a_lock():
    text = printed([run(engagement_time_s=0.88, slip_final_rpm=-3.456)])
    assert 'lock' not in text.splitlines()[1].split()
    assert 're-' not in text
    assert value_under(text, 'final', 'pi') == ('rpm', '-3.5')
    assert ' 0.880 ' in text
    assert 't_a' not in printed([run(**STICKING)])


def test_a_slip_that_has_grown_and_updates_longer_than_the_period_have_a_note():
    late = {'update_time_median_us': 15000.0, 'update_time_p99_us': 20000.0}
    text = unwrapped(printed([run(state='not_engaged', slip_final_rpm=24641.8, **late)]))
    assert 'the slip has grown: ddct check CONTROLLER finds a wrong sign or unit' in text
    assert 'its updates take 15.0 ms in the median' in text
    one_late = {'update_time_median_us': 9.0, 'update_time_p99_us': 20000.0}
    assert 'too slow' not in printed([run(**one_late)])


def test_a_ratio_to_a_least_that_is_no_bound_has_a_star_with_its_reason():
    ratios = {**STICKING, 'peak_jerk_over_least': 1.26}
    why = {'least_is_bound': 'commands the engine'}
    text = printed([run('mpc4', least_is_bound=False, null_reasons=why, **ratios)])
    assert ' 1.3* ' in text
    assert f'\n  *  commands the engine: {YARDSTICK}\n' in text
    assert '*' not in printed([run('ls8', least_is_bound=True, **ratios)])


def test_only_a_table_with_a_gear_shift_has_the_columns_of_one():
    text = printed([run(torque_dip_percent=41.2, **STICKING), run('ls8', **STICKING)])
    assert value_under(text, 'dip', 'pi') == ('%', '41')
    assert 'dip' not in printed([run(**STICKING)])


def test_a_valid_run_is_distinguished_from_an_invalid_one():
    text = printed([run('pi'), run('ls8', valid=False, state='invalid')])
    rows = {line.split()[0]: line.split()[-1] for line in text.splitlines() if line.split()}
    assert (rows['pi'], rows['ls8']) == ('engaged', 'invalid')


def test_an_undefined_metric_is_a_dash():
    lines = printed([run()]).splitlines()
    row = next(line for line in lines if 'pi' in line)
    name, *cells, state = row.split()
    assert (name, state) == ('pi', 'engaged')
    assert {cell.strip('-') for cell in cells} == {''}


def test_the_reason_of_an_invalid_run_is_below_the_table():
    text = printed([run('ls8', valid=False, reason='ended early: 1 of 2 steps ' + 'x' * 300)])
    assert f'ls8: not valid: ended early: 1 of 2 steps {"x" * 300}' in unwrapped(text)


def test_a_pipe_gets_no_escape_sequence_and_no_cut_cell():
    controller = 'a-controller-with-a-long-name-' * 2
    text = printed([run(controller, valid=False)])
    assert '\x1b' not in text
    assert controller in text


def test_brackets_are_printed_as_they_are():
    assert '[bold]' in printed([run(bag='[bold]')], (BAG,))


def test_no_color_is_honoured(monkeypatch):
    monkeypatch.setenv('TERM', 'xterm-256color')
    monkeypatch.delenv('NO_COLOR', raising=False)
    runs = [run(valid=False, reason='x')]
    assert '\x1b[1m' in printed(runs, stream=Terminal())
    monkeypatch.setenv('NO_COLOR', '1')
    coloured = [f'\x1b[{code}' for code in range(30, 50)]
    assert not any(code in printed(runs, stream=Terminal()) for code in coloured)


def test_a_terminal_of_80_columns_shows_every_number(monkeypatch):
    monkeypatch.setenv('COLUMNS', '80')
    monkeypatch.setenv('TERM', 'xterm-256color')
    numbers = {
        'time_to_final_lock_s': 1.12,
        'torque_late_s': 0.31,
        'peak_jerk_m_s3': 67.8,
        'peak_jerk_over_least': 12.6,
        'friction_work_j': 15700.0,
        'weighted_acceleration_m_s2': 0.97,
        'releases': 14,
    }
    text = printed([run('feedforward', state='not_engaged', **numbers)], stream=Terminal())
    lines = re.sub(r'\x1b\[[0-9;]*m', '', text).splitlines()
    assert max(map(len, lines)) <= 80
    (row,) = [line.split() for line in lines if 'feedforward' in line]
    assert row == [
        *('feedforward', '1.12', '0.31', '67.8', '12.6', '15.7', '0.97', '14', 'not_engaged')
    ]


def test_a_real_time_run_shows_misses_lateness_and_safe_state_each_in_its_column():
    figures = {'missed_steps': 7, 'worst_lateness_us': 1234.5}
    runs = [
        run('ls8', mode='realtime', safe_state='actuator at 0.9 s', **figures),
        run('pi', mode='realtime', safe_state='', **figures),
        run('mpc3'),
    ]
    text = printed(runs)
    for controller, row in (
        ('ls8', ('7', '1.23', 'actuator at 0.9 s')),
        ('pi', ('7', '1.23', 'none')),
        ('mpc3', ('-', '-', '-')),
    ):
        for heading, unit, cell in (('missed', 'steps', row[0]), ('latest', 'ms', row[1])):
            shown = value_under(text, heading, controller)
            assert (shown[0], re.sub('-+', '-', shown[1])) == (unit, cell)
        # The heading wraps to two lines, and the text may.
        lines = [line for line in text.splitlines() if controller in line.split()]
        words = re.sub('-+', '-', ' '.join(lines)).split()
        assert row[2].split()[0] in words
    assert 'missed' not in printed([run('mpc3')])


@pytest.mark.parametrize('name', METRICS)
def test_every_metric_can_be_a_column(name):
    column = metric(METRICS[name])
    assert isinstance(column, TextColumn)
    assert float(column.text(run(**{name: 2}))) == 2.0
    assert column.text(run()) == '-'


@pytest.mark.parametrize('stream', [io.StringIO, Terminal])
def test_no_control_character_of_a_bag_reaches_the_terminal(stream):
    evil = '\x1b]0;title\x07\x1b[2J\x9b31m\nsecond line'
    text = printed([run(bag=evil, valid=False, reason=evil)], (BAG,), stream())
    assert not set(text) & set('\x07\x9b')
    assert '\x1b]' not in text
    assert '\x1b[2J' not in text
    assert r'not valid: \x1b]0;title\x07\x1b[2J\x9b31m\nsecond line' in unwrapped(text)


def test_a_run_that_did_not_engage_has_its_reason_below_the_table():
    why = 'the plates are not locked at the end: slip 105.2 rpm after 3 releases'
    text = printed([run('ls8', state='not_engaged', why=why), run('pi')])
    rows = {line.split()[0]: line.split()[-1] for line in text.splitlines() if line.split()}
    assert (rows['ls8'], rows['pi']) == ('not_engaged', 'engaged')
    assert f'ls8: not_engaged: {why}' in unwrapped(text)
    assert 'pi:' not in text


def test_every_dash_has_its_reason_once_below_the_table():
    reasons = dict.fromkeys(METRICS, 'it has none') | {'peak_jerk_m_s3': 'it ends early'}
    text = printed([run('pi', null_reasons=reasons), run('ls8', null_reasons=reasons)])
    assert text.count('  -  it has none\n') == 1
    assert text.count('  --  it ends early\n') == 1
    complete = {key: None if each.of_shift else 1.0 for key, each in METRICS.items()}
    assert '\n  -  ' not in printed([run(**complete)])
    late = printed(
        [run(**complete | {'torque_late_s': None}, null_reasons={'torque_late_s': 'no'})]
    )
    assert '\n  -  no\n' in late


def test_a_run_that_could_not_be_read_has_one_reason_for_its_dashes():
    unread = run(valid=False, reason='unfinished', state='invalid', null_reasons={'steps': 'x'})
    text = printed([unread])
    assert text.count('\n  pi: not valid: unfinished\n') == 1
    assert '\n  --  ' not in text


def test_gains_that_were_changed_in_a_run_are_named_below_the_table():
    changes = (GainChange('kp', 0.103, 0.25, 62), GainChange('ki', 0.02, 0.0, 90))
    text = printed([run(gain_changes=changes)])
    changed = 'kp 0.103 to 0.25 at 0.62 s, ki 0.02 to 0 at 0.9 s'
    assert f'pi: gains changed in the run: {changed}' in unwrapped(text)
    assert 'gains changed' not in printed([run()])


def test_the_title_is_the_scenario_with_what_is_changed_in_it():
    changed = [run(name, scenario_changes=('load.slope_rad=0.05',)) for name in ('pi', 'ls8')]
    first = printed(changed).splitlines()[0]
    assert first.strip() == 'thesis, 1 value changed: load.slope_rad=0.05'
    assert printed([run('pi'), run('ls8')]).splitlines()[0].strip() == 'thesis'


def test_with_several_scenarios_each_row_has_its_own():
    text = printed([run('pi'), run('ls8', scenario_changes=('load.slope_rad=0.05',))])
    rows = {line.split()[0]: line for line in text.splitlines() if line.split()}
    assert 'thesis' in rows['pi']
    assert 'thesis, 1' in rows['ls8']
    assert 'load.slope_rad=0.0' in text
    assert 'thesis' not in text.splitlines()[0]


@pytest.mark.parametrize(('p99_us', 'slow'), [(9_999.0, False), (10_001.0, True)])
def test_a_controller_whose_updates_outlast_the_period_is_marked(p99_us, slow):
    times = {'update_time_median_us': 8_000.0, 'update_time_p99_us': p99_us}
    text = unwrapped(printed([run(mode='realtime', **times)]))
    assert 'too slow' not in printed([run(**times)]), 'in lock-step nothing waits'
    assert ('pi: too slow for real time: its updates take 8.0 ms in the median' in text) == slow
