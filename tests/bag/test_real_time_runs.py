# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Summary and verdict of a real-time run by `bringup`, `compare` and `score`, from its bag."""

import json

import pytest
from support.made_bags import edited

from ddct_bringup.api import shell
from ddct_bringup.bag.reader import mcap_of
from ddct_bringup.bag.writer import BagWriter
from ddct_bringup.programs import bringup, compare, score
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_plant.bag_file.records import read_records
from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.signals.topic import RunKind
from ddct_plant.signals.topics import DIAGNOSTICS, recorded_topics

STEPS = 60
COUNTS = {'steps': STEPS, 'resends': 0, 'late_messages': 0, 'tick_lateness_us': '17 1234'}
SAFE = {'since_ns': stamp_of_step(40), 'why': 'no clutch/torque_request'}
LOG = '[ERROR] [1.0] [actuator]: safe state\n'


@pytest.fixture
def leave(bags, trajectory, monkeypatch):
    """Return a function that makes every run leave a bag with these counts, state and log."""
    pytest.importorskip('rclpy', reason='rclpy serialises the messages')
    from rclpy.serialization import serialize_message

    def diagnostics(name, pairs):
        stamp = stamp_of_step(STEPS)
        texts = [(key, str(value)) for key, value in pairs.items()]
        message = DIAGNOSTICS.message(stamp, texts, name=name)
        return '/diagnostics', stamp, serialize_message(message)

    def write(folder, missed, safe):
        records = read_records(mcap_of(bags.write(trajectory, folder='source')))
        facts = edited(records.custom_data, mode='realtime')
        topics = recorded_topics(RunKind(lockstep=False))
        with BagWriter(folder, 'pi', topics, facts) as bag:
            for message in records.messages():
                bag.write(*message)
            bag.write(*diagnostics('/driveline: ticks', {**COUNTS, 'missed_steps': missed}))
            if safe:
                bag.write(*diagnostics('/actuator: safe state', SAFE))
        RunTiming(missed_steps=missed, lateness_us=[17.0, 1234.0]).write(folder)

    def leave_behind(missed=0, *, safe=False, log=''):
        def run(_plan, folder, *_, **__):
            write(folder, missed, safe)
            if log:
                (folder / 'work').mkdir()
                (folder / 'work' / 'actuator.log').write_text(log, encoding='utf-8')

        monkeypatch.setattr(shell, 'run_with_progress', run)

    return leave_behind


def test_bringup_ends_with_misses_lateness_and_safe_state(leave, tmp_path, capsys):
    leave()
    out = tmp_path / 'runs'
    assert bringup.main(['--mode', 'realtime', '--out', str(out)]) == 0
    printed = capsys.readouterr()
    assert printed.out == f'{out / "pi"}\n'
    assert printed.err.splitlines()[-2:] == [
        'bringup: 0 of 60 steps missed, worst lateness 1.23 ms, safe state: none',
        'bringup: not_engaged: the slip, -2105.5 rpm at the end, is not within 50 rpm over '
        'the last 0.3 s',
    ]


@pytest.mark.parametrize(
    ('missed', 'safe', 'reason'),
    [
        (1, False, '1 of 60 steps held a torque for want of a reply, more than 0 (1 %)'),
        (0, True, 'safe state entered by /actuator at 0.4 s'),
    ],
)
def test_bringup_fails_for_misses_and_for_a_safe_state_and_keeps_the_bag(
    leave, tmp_path, capsys, missed, safe, reason
):
    leave(missed, safe=safe, log=LOG)
    out = tmp_path / 'runs'
    assert bringup.main(['--mode', 'realtime', '--out', str(out)]) == 1
    log, summary, error = capsys.readouterr().err.splitlines()[-3:]
    partial = out / 'pi.partial'
    assert log == f'bringup: warnings are in {partial / "work" / "actuator.log"}'
    state = '/actuator at 0.4 s' if safe else 'none'
    assert summary == (
        f'bringup: {missed} of 60 steps missed, worst lateness 1.23 ms, safe state: {state}'
    )
    assert error == f'bringup: {partial}: not valid: {reason}'
    assert not (out / 'pi').exists()


def test_bringup_names_the_logs_where_the_bag_is_in_the_end(leave, tmp_path, capsys):
    leave(log='[WARN] [1.0] [load]: slow\n')
    out = tmp_path / 'runs'
    assert bringup.main(['--mode', 'realtime', '--out', str(out)]) == 0
    log = out / 'pi' / 'work' / 'actuator.log'
    assert f'bringup: warnings are in {log}\n' in capsys.readouterr().err
    assert log.is_file()


def test_compare_fails_and_its_table_and_scores_have_the_reason(leave, tmp_path, capsys):
    leave(7, safe=True, log=LOG)
    out = tmp_path / 'runs'
    arguments = ['--controllers', 'pi', '--mode', 'realtime', '--json', '-', '--out', str(out)]
    assert compare.main(arguments) == 1
    printed = capsys.readouterr()
    (entry,) = json.loads(printed.out)['runs']
    assert (entry['valid'], entry['safe_state']) == (False, '/actuator at 0.4 s')
    assert entry['reason'] == (
        '7 of 60 steps held a torque for want of a reply, more than 0 (1 %); '
        'safe state entered by /actuator at 0.4 s'
    )
    metrics = entry['metrics']
    assert (metrics['missed_steps'], metrics['worst_lateness_us']) == (7, 1234.0)
    words = ' '.join(line for line in printed.err.splitlines() if line.startswith('  pi ')).split()
    assert ' 7 1.23 ' in ' '.join(words)
    assert {'/actuator', 'invalid'} <= {*words}
    summary = '7 of 60 steps missed, worst lateness 1.23 ms, safe state: /actuator at 0.4 s'
    assert f'ddct compare: pi: {summary}\n' in printed.err
    assert f'warnings are in {tmp_path / "runs.partial" / "pi" / "work"}' in printed.err


def test_score_judges_the_bag_without_its_timing_file(leave, tmp_path, capsys):
    leave(0, safe=True)
    assert bringup.main(['--mode', 'realtime', '--out', str(tmp_path / 'runs')]) == 1
    partial = tmp_path / 'runs' / 'pi.partial'
    (partial / 'timing.json').unlink()
    capsys.readouterr()
    assert score.main([str(partial)]) == 1
    printed = ' '.join(capsys.readouterr().out.split())
    assert 'safe state entered by /actuator at 0.4 s' in printed
