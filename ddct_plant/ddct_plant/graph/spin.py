# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Run one node, or several in one process, until they are done or a signal stops them."""

import gc
import itertools
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import rclpy
from rclpy.executors import Executor, ExternalShutdownException, SingleThreadedExecutor
from rclpy.task import Future

from ddct_plant.base.errors import DdctError, ForeignError
from ddct_plant.graph.arguments import (
    HELP,
    init_ros,
    node_help,
    require_declared,
    require_ros_arguments,
)
from ddct_plant.graph.node import GraphNode
from ddct_plant.program.command_line import run_program
from ddct_plant.program.signals import ends_at_once, stop_signals
from ddct_plant.program.supervision import announce_exit, beat

SLICE_S = 0.1
"""Period in s at which signals are checked, and the longest spin of the executor."""
_CHECKS_PER_COLLECTION = 10
"""Number of checks of signals for one collection of a generation's elders, as in Python."""
LAST_SLICE_S = 0.03
"""Time in s that a stopped node still receives messages that are on their way."""


def make_executor(context: Any = None) -> Executor:
    """Return the fast EventsExecutor where this rclpy has it, else the standard one."""
    try:
        from rclpy.experimental.events_executor import EventsExecutor
    except ImportError:
        return SingleThreadedExecutor(context=context)
    return EventsExecutor(context=context)


def end_of(nodes: Sequence[GraphNode], stopped: Callable[[], bool]) -> Future:
    """
    Return a future that is set once any of the nodes is done or `stopped()` is true.

    A timer checks `stopped`, because a busy EventsExecutor does not return at its timeout, and
    collects garbage.
    """
    over: Future = Future()
    checks = itertools.count(1)

    def end(*_: object) -> None:
        if not over.done():
            over.set_result(None)

    for node in nodes:
        node.done.add_done_callback(end)

    def check() -> None:
        gc.collect(_generation_of(next(checks)))
        if stopped():
            end()

    nodes[0].steady_time.every(nodes[0], SLICE_S, check)
    return over


def spin_until(executor: Executor, over: Future) -> None:
    """
    Spin in finite slices until the future `over` is set.

    Jazzy's EventsExecutor spins without end at full load when it is called without a timeout.
    """
    with _garbage_collected_by_timer():
        while not over.done():
            executor.spin_until_future_complete(over, SLICE_S)


@contextmanager
def _garbage_collected_by_timer() -> Iterator[None]:
    """
    Let no allocation start a garbage collection, and undo that at the end.

    Objects of the start stay for the whole run, and messages contain no reference cycles: the
    timer of `end_of` has little to collect, mostly between two ticks. Nothing is frozen where the
    caller has frozen objects, because the two could not be told apart at the end.
    """
    enabled, ours = gc.isenabled(), not gc.get_freeze_count()
    gc.collect()
    if ours:
        gc.freeze()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()
        if ours:
            gc.unfreeze()


def _generation_of(check: int) -> int:
    """Return the oldest generation of objects that is collected at a check, counted from 1."""
    if check % _CHECKS_PER_COLLECTION**2 == 0:
        return 2
    return int(check % _CHECKS_PER_COLLECTION == 0)


def finish_node(executor: Executor, node: GraphNode) -> None:
    """Let the node receive the messages that have already arrived, then flush it."""
    if not node.done.done():
        over: Future = Future()
        timer = node.steady_time.every(
            node, LAST_SLICE_S, lambda: over.done() or over.set_result(None)
        )
        executor.spin_until_future_complete(over, SLICE_S)
        # Else it wakes the executor while the other nodes of the process are finished.
        timer.cancel()
    node.close()


@contextmanager
def watched_stops() -> Iterator[Callable[[], bool]]:
    """Yield a function for `end_of`: it beats, and returns whether SIGINT or SIGTERM has come."""
    with stop_signals() as stops:

        def stopped() -> bool:
            beat()
            return bool(stops)

        yield stopped


def run_node(
    name: str, factory: Callable[[], GraphNode], arguments: Sequence[str] | None = None
) -> int:
    """
    Run the node that `factory` builds and return the exit code of its program.

    A program that has arguments of its own, or its own `--help`, passes on its whole command line
    as `arguments`, checked. The exit code is 0 after its work is done, after SIGINT or SIGTERM,
    or after `--help`; 1 after a DdctError, with one line on standard error. For an error of a
    third party's code its traceback precedes that line.
    """
    built: list[GraphNode] = []

    def program(argv: list[str]) -> int:
        if arguments is None:
            if not HELP.isdisjoint(argv):
                print(node_help(name, factory, sys.argv))
                return 0
            require_ros_arguments(argv)
        with watched_stops() as stopped:
            error = _run(factory, arguments, stopped, built)
        if isinstance(error, ForeignError):
            traceback.print_exception(error)
        if error is not None:
            raise error
        return 0

    code = 1
    try:
        code = run_program(name, program, None)
    finally:
        _leave(built, code)
    return code


def _run(
    factory: Callable[[], GraphNode],
    arguments: Sequence[str] | None,
    stopped: Callable[[], bool],
    built: list[GraphNode],
) -> DdctError | None:
    """
    Return the error that ended the node, if any; raise DdctError when it cannot be built.

    The node is appended to `built`, and is flushed at the end.
    """
    try:
        init_ros(arguments)
        node = factory()
        built.append(node)
        require_declared(node)
        node.announce()
        executor = make_executor()
        executor.add_node(node)
        # As well as what the parent of a forked node has frozen; the process ends with its node.
        gc.collect()
        gc.freeze()
        spin_until(executor, end_of([node], stopped))
        finish_node(executor, node)
        return node.done.result() if node.done.done() else None
    except ExternalShutdownException:
        return None


def _leave(nodes: Sequence[GraphNode], code: int) -> None:
    """
    Remove the nodes, whose work is over, from the graph.

    Fast DDS may hang here for ever when other nodes leave at the same time. The supervisor then
    ends the process, and takes `code` for its exit code.
    """
    announce_exit(code)
    with ends_at_once():
        for node in nodes:
            node.destroy_node()
        rclpy.try_shutdown()
