# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Each node killed, stopped for half a second, and stopped for good."""

from collections.abc import Iterator
from itertools import product

from faults.campaign.case import (
    CLUTCHES,
    ENDED_BY_FAULT,
    IN_REAL_TIME,
    INSTANTS,
    LONG,
    MODES,
    Case,
)
from faults.campaign.outcome import REFUSED, RUNS_ON, SAME, Stated, either, named, safe_state
from faults.campaign.process_runs import kill, pause, stop

from ddct_bringup.processes.graph_nodes import nodes_of

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

_NODES_OF_ONE = [spec.path for spec in nodes_of(shift=False)]


def _after_kill(node: str, mode: str) -> Stated:
    words = f'node {node} was killed by SIGKILL'
    return named(words) if mode == 'lockstep' else named(words, within_s=GONE_S)


def _after_stop(node: str, instant: str, mode: str) -> Stated:
    if node == 'driveline':
        return named('node driveline has shown no sign of life')
    silent = named(f'no {ANSWERS[node]}') if node != 'engine' else named('engine/torque')
    by_pulse = named(f'node {node} has shown no sign of life')
    if mode == 'lockstep' or instant != 'middle':
        return either(silent, by_pulse, *([RUNS_ON] if mode == 'realtime' else []))
    if node in OPENS:
        return safe_state(*OPENS[node], stopped=node)
    return either(silent, by_pulse, RUNS_ON)


def _after_pause(node: str, instant: str, mode: str) -> Stated:
    if mode == 'lockstep':
        return SAME
    if node == 'recorder':
        return either(RUNS_ON, REFUSED)
    if instant == 'middle' and node in OPENS:
        return safe_state(*OPENS[node])
    return RUNS_ON


def cases() -> Iterator[Case]:
    """Yield the faults of each node; with two clutches what is as with one in the middle alone."""
    for clutches, mode, instant in product(CLUTCHES, MODES, INSTANTS):
        lockstep = mode == 'lockstep'
        pause_steps = LONG if lockstep else IN_REAL_TIME
        end_steps = ENDED_BY_FAULT if lockstep else IN_REAL_TIME
        for spec in nodes_of(shift=clutches == 2):
            node, common = spec.path, (instant, mode, clutches)
            if clutches == 2 and node in _NODES_OF_ONE and instant != 'middle':
                continue
            yield Case('node killed', node, *common, _after_kill(node, mode), kill, end_steps)
            paused = _after_pause(node, instant, mode)
            yield Case('node stopped for 0.5 s', node, *common, paused, pause, pause_steps)
            stopped = _after_stop(node, instant, mode)
            yield Case('node stopped for good', node, *common, stopped, stop, end_steps)
