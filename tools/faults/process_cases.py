# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nodes killed, stopped for half a second, and stopped for good."""

from collections.abc import Iterator

from faults.case import ENDED_BY_FAULT, IN_REAL_TIME, LONG, Case, Where, places
from faults.outcome import REFUSED, RUNS_ON, SAME, Stated, either, named, safe_state
from faults.process_runs import kill, pause, stop

OPENS = {
    'actuator': ('driveline',),
    'clutch': ('driveline',),
    'controller': ('actuator',),
    'reference': ('actuator',),
    'handover': ('actuator', 'off_going/actuator', 'engine'),
    'off_going/actuator': ('driveline',),
    'off_going/clutch': ('driveline',),
}
"""Nodes that enter their safe state in real time when a node stops, by the node that stops."""
GONE_S = 0.5
"""Time in s within which a real-time run ends whose node is gone, on a busy machine."""
ANSWERS = {
    'engine': 'engine/torque',
    'load': 'load/torque',
    'clutch': 'clutch/torque',
    'actuator': 'clutch/torque',
    'reference': 'clutch/torque',
    'controller': 'clutch/torque',
    'recorder': 'recorder/ack',
    'handover': 'clutch/torque',
    'off_going/clutch': 'off_going/clutch/torque',
    'off_going/actuator': 'off_going/clutch/torque',
}
"""A topic that stays away when a node has stopped."""

KILLED: Where = {
    ('start', 'lockstep', 1): ('load', 'driveline'),
    ('middle', 'lockstep', 1): ('driveline', 'recorder', 'controller'),
    ('middle', 'lockstep', 2): ('off_going/clutch',),
    ('middle', 'realtime', 1): ('driveline', 'recorder', 'clutch'),
}
PAUSED: Where = {
    ('middle', 'lockstep', 1): ('driveline', 'recorder', 'controller'),
    ('middle', 'lockstep', 2): ('off_going/clutch',),
    ('start', 'realtime', 1): ('load',),
    ('middle', 'realtime', 1): ('driveline', 'recorder', 'controller', 'clutch'),
    ('middle', 'realtime', 2): ('handover',),
}
STOPPED: Where = {
    ('start', 'lockstep', 1): ('controller',),
    ('middle', 'lockstep', 1): ('driveline', 'recorder', 'engine'),
    ('start', 'realtime', 1): ('actuator',),
    ('middle', 'realtime', 1): ('driveline', 'recorder', 'controller', 'clutch', 'load'),
    ('middle', 'realtime', 2): ('handover',),
}


def _after_kill(node: str, instant: str, mode: str) -> Stated:
    words = f'node {node} was killed by SIGKILL'
    return named(words) if mode == 'lockstep' else named(words, within_s=GONE_S)


def _after_stop(node: str, instant: str, mode: str) -> Stated:
    if node == 'driveline':
        return named('node driveline has been paused')
    silent = named(f'no {ANSWERS[node]}') if node != 'engine' else named('engine/torque')
    by_state = named(f'node {node} has been paused')
    if mode == 'lockstep' or instant != 'middle':
        return either(silent, by_state, *([RUNS_ON] if mode == 'realtime' else []))
    if node in OPENS:
        return safe_state(*OPENS[node], stopped=node)
    return either(silent, by_state, RUNS_ON)


def _after_pause(node: str, instant: str, mode: str) -> Stated:
    if mode == 'lockstep':
        return SAME
    if node == 'recorder':
        return either(RUNS_ON, REFUSED)
    if instant == 'middle' and node in OPENS:
        return safe_state(*OPENS[node])
    return RUNS_ON


def cases() -> Iterator[Case]:
    """Yield each fault of each of its targets."""
    kinds = (
        ('node killed', KILLED, _after_kill, kill, ENDED_BY_FAULT),
        ('node stopped for 0.5 s', PAUSED, _after_pause, pause, LONG),
        ('node stopped for good', STOPPED, _after_stop, stop, ENDED_BY_FAULT),
    )
    for fault, where, stated_of, attempt, in_lockstep in kinds:
        for node, instant, mode, clutches in places(where):
            stated = stated_of(node, instant, mode)
            steps = in_lockstep if mode == 'lockstep' else IN_REAL_TIME
            yield Case(fault, node, instant, mode, clutches, stated, attempt, steps)
