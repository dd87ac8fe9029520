# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of runs on terminals, in pipes, and without colours."""

import io
import re
from dataclasses import replace

import pytest
from made_scores import made_result, made_verdict
from made_scores import made_scores as run
from printed_table import value_under

from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.scores.run_table import BAG, COLUMNS, CONTROLLER, WEAR, metric, print_runs
from ddct_plant.program.table import Column, Quantity
from ddct_plant.signals.gain_changes import GainChange


class Terminal(io.StringIO):
    def isatty(self):
        return True


def unwrapped(text):
    """Return a text with the lines of a note joined; a word that is wider has no space within."""
    joined = re.sub(r'(?<=x)\n  (?=x)', '', text)
    return re.sub(r'\n  +', ' ', joined)


def printed(runs, columns=(CONTROLLER, WEAR, *COLUMNS), stream=None):
    stream = stream or io.StringIO()
    print_runs(runs, columns, stream)
    return stream.getvalue()


@pytest.mark.parametrize(
    ('heading', 'unit', 'metric_name', 'value', 'shown'),
    [
        ('t_a', 's', 'engagement_time_s', 0.88, '0.880'),
        ('std w_sr', 'rpm', 'torsion_speed_std_rpm', 0.7049, '0.705'),
        ('std A_x', 'm/s^2', 'acceleration_std_m_s2', 0.1806, '0.181'),
        ('final', 'rpm', 'slip_final_rpm', -3.456, '-3.46'),
        ('slip', 'rpm', 'slip_rmse_rpm', 7.891, '7.89'),
        ('jerk', 'm/s^3', 'peak_jerk_m_s3', 12.345, '12.35'),
    ],
)
def test_a_value_is_below_its_heading_and_unit(heading, unit, metric_name, value, shown):
    others = dict.fromkeys(METRICS, 1000.0)
    text = printed([run(**{**others, metric_name: value})])
    assert value_under(text, heading, 'pi') == (unit, shown)


def test_a_valid_run_is_distinguished_from_an_invalid_one():
    text = printed([run('pi'), run('ls8', valid=False)])
    rows = {line.split()[0]: line.split()[-1] for line in text.splitlines() if line.split()}
    assert (rows['pi'], rows['ls8']) == ('yes', 'NO')


def test_an_undefined_metric_is_a_dash():
    lines = printed([run()]).splitlines()
    row = next(line for line in lines if 'pi' in line)
    assert row.split()[:2] == ['pi', '1']
    assert [cell.strip('-') for cell in row.split()[2:8]] == [''] * 6
    assert row.split()[8:] == ['invalid', 'failed', 'yes']


def test_the_reason_of_an_invalid_run_is_below_the_table():
    text = printed([run('ls8', valid=False, reason='ended early: 1 of 2 steps ' + 'x' * 300)])
    assert f'ls8: not valid: ended early: 1 of 2 steps {"x" * 300}' in unwrapped(text)


def test_a_pipe_gets_no_escape_sequence_and_no_cut_cell():
    controller = 'a-controller-with-a-long-name-' * 2
    text = printed([run(controller, valid=False)])
    assert '\x1b' not in text
    assert controller in text


def test_brackets_are_printed_as_they_are():
    assert '[bold]' in printed([run(bag='[bold]')], (BAG, *COLUMNS))


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
        'engagement_time_s': 0.881,
        'torsion_speed_std_rpm': 12.345,
        'acceleration_std_m_s2': 0.205,
        'slip_final_rpm': -123.45,
        'slip_rmse_rpm': 123.45,
        'peak_jerk_m_s3': 67.89,
    }
    text = printed([run('feedforward', **numbers)], stream=Terminal())
    for number in ('0.881', '12.345', '0.205', '-123.45', ' 123.45', '67.89', 'feedforward'):
        assert number in text


def test_a_real_time_run_shows_misses_lateness_and_safe_state_each_in_its_column():
    columns = (CONTROLLER, *COLUMNS)
    figures = {'missed_steps': 7, 'worst_lateness_us': 1234.5}
    runs = [
        run('ls8', mode='realtime', safe_state='actuator at 0.9 s', **figures),
        run('pi', mode='realtime', safe_state='', **figures),
        run('mpc3'),
    ]
    text = printed(runs, columns)
    for controller, row in (
        ('ls8', ('7', '1.23', 'actuator at 0.9 s')),
        ('pi', ('7', '1.23', 'none')),
        ('mpc3', ('----', '-----', '------')),
    ):
        assert value_under(text, 'missed', controller) == ('steps', row[0])
        assert value_under(text, 'latest', controller) == ('ms', row[1])
        # The heading wraps to two lines, and the text may.
        lines = [line for line in text.splitlines() if controller in line.split()]
        assert any(row[2].split()[0] in line.split() for line in lines)
    assert 'missed' not in printed([run('mpc3')], columns)


@pytest.mark.parametrize('name', METRICS)
def test_every_metric_can_be_a_column(name):
    column = metric(Quantity(name, 'symbol', 'unit', '.1f', 'meaning'), 'heading')
    assert isinstance(column, Column)
    assert column.text(run(**{name: 2})) == '2.0'


@pytest.mark.parametrize('stream', [io.StringIO, Terminal])
def test_no_control_character_of_a_bag_reaches_the_terminal(stream):
    evil = '\x1b]0;title\x07\x1b[2J\x9b31m\nsecond line'
    text = printed([run(bag=evil, valid=False, reason=evil)], (BAG, *COLUMNS), stream())
    assert not set(text) & set('\x07\x9b')
    assert '\x1b]' not in text
    assert '\x1b[2J' not in text
    assert r'not valid: \x1b]0;title\x07\x1b[2J\x9b31m\nsecond line' in unwrapped(text)


def verdict_beyond():
    within = made_result('peak_jerk', 1.0, 2.0, unit='m/s^3')
    beyond = made_result('judder', 4.0, 3.0, unit='rpm', source='B, 2', state='beyond')
    return made_verdict('nearly_engaged', 'beyond', within, beyond)


def test_a_run_has_its_state_its_limits_and_a_note_on_each_one_exceeded():
    text = printed([run('ls8', verdict=verdict_beyond())])
    row = next(line for line in text.splitlines() if 'ls8' in line.split())
    assert row.split()[-3:] == ['nearly_engaged', 'beyond', 'yes']
    assert 'beyond judder 3 rpm (B, 2): ls8 4\n' in text
    assert 'peak_jerk' not in text


def test_a_limit_is_named_once_with_all_runs_beyond_it():
    runs = [run(name, verdict=verdict_beyond()) for name in ('pi', 'ls8')]
    assert printed([*runs, run('mpc3')]).count('B, 2') == 1
    assert 'beyond judder 3 rpm (B, 2): pi 4, ls8 4\n' in printed(runs)


def test_a_run_above_the_traction_of_the_driven_axle_is_named():
    source = {'source': 'convention: C', 'convention': True}
    traction = made_result('traction', 12.79, 4.905, unit='m/s^2', state='beyond', **source)
    text = printed([run('mpc4', verdict=replace(verdict_beyond(), traction=traction))])
    assert 'beyond traction 4.905 m/s^2 (convention: C): mpc4 12.79\n' in text


def test_an_engaged_run_has_a_note_on_limits_that_cannot_be_checked():
    no_value = made_result('peak_temperature', None, 300.0, unit='degC', state='no_limit')
    engaged = made_verdict('engaged', 'no_limit', no_value)
    said = 'pi: not known to keep within its limits: no value of peak_temperature\n'
    assert said in printed([run(verdict=engaged)])
    for other in ({'state': 'runaway'}, {'limits': 'beyond'}):
        assert 'not known' not in printed([run(verdict=replace(engaged, **other))])


def test_a_narrow_terminal_has_state_and_limits_in_a_block_of_their_own(monkeypatch):
    monkeypatch.setenv('COLUMNS', '80')
    text = printed([run('feedforward', verdict=verdict_beyond())], stream=Terminal())
    rows = [line.split() for line in text.splitlines() if 'feedforward' in line.split()]
    assert rows[-1][:2] == ['feedforward', 'nearly_engaged'] or 'nearly_engaged' in rows[0]
    assert 'nearly_engaged' in ' '.join(map(str, rows))
    assert max(map(len, re.sub(r'\x1b\[[0-9]*m', '', text).splitlines())) <= 80


def test_every_dash_has_its_reason_once_below_the_table():
    text = printed([run('pi', steps=300), run('ls8', steps=300)])
    for mark in ('-', '--', '---'):
        assert sum(line.startswith(f'  {mark}  ') for line in text.splitlines()) == 1
    complete = dict.fromkeys(METRICS, 1.0)
    assert '\n  -  ' not in printed([run(**complete)])
    assert '\n  -  after control start' in printed([run(**complete | {'engagement_time_s': None})])


def test_a_run_that_could_not_be_read_has_one_reason_for_its_dashes():
    text = printed([run(valid=False, reason='unfinished')])
    assert text.count('\n  -  not valid: unfinished\n') == 1 and '\n  --  ' not in text
    assert 'pi: not valid: unfinished' in text


def test_a_bag_from_before_the_schema_is_marked():
    assert 'pi: recorded before' in printed([run(before_schema=True)])


def test_gains_that_were_changed_in_a_run_are_named_below_the_table():
    changes = (GainChange('kp', 0.103, 0.25, 62), GainChange('ki', 0.02, 0.0, 90))
    text = printed([run(gain_changes=changes)])
    changed = 'kp 0.103 to 0.25 at 0.62 s, ki 0.02 to 0 at 0.9 s'
    assert f'pi: gains changed in the run: {changed}\n' in text
    assert 'gains changed' not in printed([run()])


def test_the_title_is_the_scenario_with_what_is_changed_in_it():
    changed = [run(name, scenario_changes=('load.slope_rad=0.05',)) for name in ('pi', 'ls8')]
    first = printed(changed).splitlines()[0]
    assert first.strip() == 'thesis, 1 value changed: load.slope_rad=0.05'
    assert printed([run('pi'), run('ls8')]).splitlines()[0].strip() == 'thesis'


def test_with_several_scenarios_each_row_has_its_own():
    text = printed([run('pi'), run('ls8', scenario_changes=('load.slope_rad=0.05',))])
    assert '\npi: thesis\n' in text
    assert '\nls8: thesis, 1 value changed: load.slope_rad=0.05\n' in text
    assert 'thesis' not in text.splitlines()[0]


@pytest.mark.parametrize(('p99_us', 'slow'), [(9_999.0, False), (10_001.0, True)])
def test_a_controller_whose_updates_outlast_the_period_is_marked(p99_us, slow):
    text = printed([run(update_time_median_us=8_000.0, update_time_p99_us=p99_us)])
    assert ('pi: too slow for real time: its updates take 8.0 ms in the median' in text) == slow
