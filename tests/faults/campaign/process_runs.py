# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A run in processes, with a fault of one of them at a step; and the cases of such faults."""

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import product
from pathlib import Path
from typing import Any

import rclpy
from faults.campaign.case import (
    CLUTCHES,
    ENDED_BY_FAULT,
    IN_REAL_TIME,
    INSTANTS,
    LONG,
    MODES,
    REFUSED,
    RUNS_ON,
    SAME,
    Case,
    Observed,
    Stated,
    either,
    named,
    safe_state,
)
from faults.campaign.leftovers import Leftovers
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rosgraph_msgs.msg import Clock
from support.shared_parent import shared_parent

from ddct_bringup.processes import node_process
from ddct_bringup.processes.graph_nodes import NodeSpec, nodes_of
from ddct_bringup.processes.node_processes import NodeProcesses
from ddct_bringup.run import execution, plan
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import step_of_stamp
from ddct_plant.graph.qos import RECORDER_QOS
from ddct_plant.signals.message_kind import stamp_ns

PAUSE_S = 0.5
PATIENCE_S = 3.0
"""Wall time in s after which a silent node ends a run here; 20 s for users."""


@contextmanager
def at_step(step: int, act: Callable[[int], None]) -> Iterator[None]:
    """Call `act(step)` once, at the first tick from `step` on, in a thread of its own."""
    context = Context()
    rclpy.init(args=[], context=context, signal_handler_options=SignalHandlerOptions.NO)
    node = Node('watch', context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    over = threading.Event()

    def on_clock(message: Clock) -> None:
        if not over.is_set() and (now := step_of_stamp(stamp_ns(message))) >= step:
            over.set()
            act(now)

    node.create_subscription(Clock, '/clock', on_clock, RECORDER_QOS)
    stop = threading.Event()

    def spin() -> None:
        while not stop.is_set():
            executor.spin_once(timeout_sec=0.05)

    thread = threading.Thread(target=spin)
    thread.start()
    try:
        yield
    finally:
        stop.set()
        thread.join()
        executor.shutdown()
        node.destroy_node()
        context.try_shutdown()


@contextmanager
def _short_patience() -> Iterator[None]:
    """Let the supervisor of this process, and the driveline, give up earlier."""
    changed: Sequence[tuple[Any, str]] = (
        (plan, 'ANSWER_TIMEOUT_S'),
        (node_process, 'ANSWER_TIMEOUT_S'),
        (node_process, 'START_S'),
    )
    before = [getattr(module, name) for module, name in changed]
    for module, name in changed:
        setattr(module, name, 10.0 if name == 'START_S' else PATIENCE_S)
    try:
        yield
    finally:
        for (module, name), value in zip(changed, before, strict=True):
            setattr(module, name, value)


def run_with_fault(case: Case, folder: Path, harm: Callable[[int], None]) -> Observed:
    """Record the run of a case; `harm(pid)` is done to its target at its instant."""
    seen, leftovers = Observed(), Leftovers()
    pids: dict[str, int] = {}

    class Tapped(NodeProcesses):
        """Processes whose ids the campaign knows."""

        def start(self, specs: Sequence[NodeSpec]) -> None:
            super().start(specs)
            nodes: Any = self._nodes
            pids.update({node.name: node.process.pid for node in nodes})

    def act(step: int) -> None:
        seen.fault_step = step
        for pid in pids.values():
            leftovers.note(pid)
        harm(pids[case.target])

    real, modules = execution.NodeProcesses, execution
    setattr(modules, 'NodeProcesses', Tapped)  # noqa: B010
    try:
        with _short_patience(), at_step(case.begin, act):
            execution.execute(case.run, folder, parent=shared_parent())
    except DdctError as error:
        seen.error = str(error).partition('; its log is')[0]
    finally:
        setattr(modules, 'NodeProcesses', real)  # noqa: B010
    seen.read(folder, case.run)
    seen.left = leftovers.found()
    return seen


def kill(case: Case, folder: Path) -> Observed:
    """Kill the target."""
    return run_with_fault(case, folder, lambda pid: os.kill(pid, signal.SIGKILL))


def pause(case: Case, folder: Path) -> Observed:
    """Stop the target for half a second."""

    def harm(pid: int) -> None:
        os.kill(pid, signal.SIGSTOP)
        time.sleep(PAUSE_S)
        os.kill(pid, signal.SIGCONT)

    return run_with_fault(case, folder, harm)


def stop(case: Case, folder: Path) -> Observed:
    """Stop the target for good."""
    return run_with_fault(case, folder, lambda pid: os.kill(pid, signal.SIGSTOP))


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
WITHIN_S = 0.3
"""Timeout of a clutch torque, and time for the signal on a busy machine."""
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


def _after_stop(node: str, instant: str, mode: str) -> Stated:
    if node == 'driveline':
        return named('node driveline has shown no sign of life')
    silent = named(f'no {ANSWERS[node]}') if node != 'engine' else named('engine/torque')
    by_pulse = named(f'node {node} has shown no sign of life')
    if mode == 'lockstep' or instant != 'middle':
        return either(silent, by_pulse, *([RUNS_ON] if mode == 'realtime' else []))
    if node in OPENS:
        return safe_state(*OPENS[node], within_s=WITHIN_S)
    return either(silent, by_pulse, RUNS_ON)


def _after_pause(node: str, instant: str, mode: str) -> Stated:
    if mode == 'lockstep':
        return SAME
    if node == 'recorder':
        return either(RUNS_ON, REFUSED)
    if instant == 'middle' and node in OPENS:
        return safe_state(*OPENS[node], within_s=WITHIN_S)
    return RUNS_ON


def cases() -> Iterator[Case]:
    """Yield the nodes killed, paused and stopped; with two clutches a part of the product."""
    for clutches, mode, instant in product(CLUTCHES, MODES, INSTANTS):
        lockstep = mode == 'lockstep'
        pause_steps = LONG if lockstep else IN_REAL_TIME
        end_steps = ENDED_BY_FAULT if lockstep else IN_REAL_TIME
        for spec in nodes_of(shift=clutches == 2):
            node, common = spec.path, (instant, mode, clutches)
            # What also one clutch has is tried with two in the middle of lock-step alone.
            known = clutches == 2 and node in _NODES_OF_ONE
            if known and (mode, instant) != ('lockstep', 'middle'):
                continue
            killed = named(f'node {node} was killed by SIGKILL')
            yield Case('node killed', node, *common, killed, kill, end_steps)
            paused = _after_pause(node, instant, mode)
            yield Case('node stopped for 0.5 s', node, *common, paused, pause, pause_steps)
            if not known and (clutches == 1 or instant == 'middle'):
                stopped = _after_stop(node, instant, mode)
                yield Case('node stopped for good', node, *common, stopped, stop, end_steps)
