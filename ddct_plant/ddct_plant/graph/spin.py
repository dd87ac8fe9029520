"""Run one node, or several in one process, until done or asked to stop."""

import gc
import signal
import sys
from collections.abc import Callable
from typing import Any

import rclpy
from rclpy.executors import Executor, ExternalShutdownException, SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

from ddct_plant.errors import DdctError
from ddct_plant.graph.node import GraphNode

SLICE_S = 0.1
"""Longest time the executor runs before signals are looked at."""


LAST_SLICE_S = 0.03
"""How long a stopped node still takes in messages that are on their way."""


def make_executor(context: Any = None) -> Executor:
    """Return the fast EventsExecutor where this rclpy has it, else the standard one."""
    try:
        from rclpy.experimental.events_executor import EventsExecutor
    except ImportError:
        return SingleThreadedExecutor(context=context)
    return EventsExecutor(context=context)


def spin_until(executor: Executor, done: Any, stopped: Callable[[], bool]) -> None:
    """
    Spin in finite slices until the future `done` is set or `stopped()` is true.

    Jazzy's EventsExecutor spins without end at full load when it is called without a timeout.
    """
    # What start-up made stays: collecting it again and again would interrupt the loop.
    gc.collect()
    gc.freeze()
    while not done.done() and not stopped():
        executor.spin_until_future_complete(done, SLICE_S)


def stop_signals() -> list[int]:
    """Catch SIGINT and SIGTERM from now on, and return the list that they are put into."""
    received: list[int] = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda caught, _frame: received.append(caught))
    return received


def finish_node(executor: Executor, node: GraphNode) -> None:
    """Let the node take in what has already reached it, then flush it."""
    if not node.done.done():
        executor.spin_until_future_complete(node.done, LAST_SLICE_S)
    node.close()


def run_node(
    name: str, factory: Callable[[], GraphNode], arguments: list[str] | None = None
) -> int:
    """
    Run the node that `factory` builds and return the exit code of its program.

    0 after its work is done or after SIGINT or SIGTERM; 1, with one line on standard error, after
    a DdctError.
    """
    stops = stop_signals()
    rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
    try:
        node = factory()
        executor = make_executor()
        executor.add_node(node)
        spin_until(executor, node.done, lambda: bool(stops))
        finish_node(executor, node)
        error = node.done.result() if node.done.done() else None
        node.destroy_node()
    except DdctError as failure:
        error = failure
    except ExternalShutdownException:
        error = None
    finally:
        rclpy.try_shutdown()
    if error is None:
        return 0
    print(f'{name}: {error}', file=sys.stderr, flush=True)
    return 1
