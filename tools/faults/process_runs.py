# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A run in processes, with a fault of one of them at a step."""

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unittest.mock import patch

import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rosgraph_msgs.msg import Clock
from waiting import wait_until

from ddct_bringup import processes
from ddct_bringup.processes import supervisor
from ddct_bringup.processes.graph_nodes import NodeSpec
from ddct_bringup.processes.supervisor import Supervisor
from ddct_bringup.run import execution, plan
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import step_of_stamp
from ddct_plant.graph.qos import RECORDER_QOS
from ddct_plant.program.supervision import Patience
from ddct_plant.signals.message_kind import stamp_ns
from faults.case import Case
from faults.leftovers import Leftovers
from faults.outcome import NEVER, Observed

PAUSE_S = 0.5
PATIENCE_S = 3.0
"""Wall time in s after which a silent node ends a run here; 20 s for users."""
PAUSED_S, PATIENCE = 2.0, Patience(start_s=10.0, silent_s=2.5)
"""Those of the supervisor here."""


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
    changed: Sequence[tuple[Any, str, Any]] = (
        (plan, 'ANSWER_TIMEOUT_S', PATIENCE_S),
        (supervisor, 'PAUSED_S', PAUSED_S),
        (supervisor, 'PATIENCE', PATIENCE),
    )
    before = [getattr(module, name) for module, name, _ in changed]
    for module, name, value in changed:
        setattr(module, name, value)
    try:
        yield
    finally:
        for (module, name, _), value in zip(changed, before, strict=True):
            setattr(module, name, value)


def run_with_fault(case: Case, folder: Path, harm: Callable[[int], None]) -> Observed:
    """Record the run of a case; `harm(pid)` is done to its target at its instant."""
    seen, leftovers = Observed(fault_step=NEVER), Leftovers()
    pids: dict[str, int] = {}

    class Tapped(Supervisor):
        """Processes whose ids the campaign knows."""

        def start(self, specs: Sequence[NodeSpec]) -> None:
            super().start(specs)
            pids.update({node.name: node.pid for node in self._nodes})

    def act(step: int) -> None:
        # The nodes may have begun before the supervisor goes on.
        wait_until(lambda: case.target in pids, 'the start of all nodes')
        seen.fault_step = step
        for pid in pids.values():
            leftovers.note(pid)
        harm(pids[case.target])

    tapped = patch.object(processes, 'Supervisor', Tapped)
    try:
        with tapped, _short_patience(), at_step(case.begin, act):
            execution.execute(case.run, folder)
    except DdctError as error:
        seen.error = str(error).partition('; its log is')[0]
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
