# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Nodes of the graph inside the test's process, in virtual time.

A test can leave out, replace or add some.
"""

import importlib
import time
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future
from stepped_time import SteppedTime
from waiting import WITHIN_S, wait_until

from ddct_bringup.processes.graph_nodes import NodeSpec, nodes_of
from ddct_bringup.run.plan import RunPlan
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.spin import finish_node, make_executor
from ddct_plant.graph.steady_time import SteadyTime
from ddct_plant.nodes.driveline_node import DrivelineNode
from ddct_plant.scenario.case import OF_CASE

CHECK_PERIOD_S = 0.001
"""Period of the checks of a condition while a graph with the wall clock spins, s."""


def node_spec(path: str) -> NodeSpec:
    """Return the description of the node with this full name within its graph."""
    return next(spec for spec in nodes_of(shift=True) if spec.path == path)


def node_class(path: str) -> type[GraphNode]:
    """Return the class of the node with this full name within its graph."""
    spec = node_spec(path)
    return getattr(importlib.import_module(spec.module), spec.class_name)


class InProcessGraph:
    """
    Nodes of one run on one executor; as a context manager it destroys them.

    Time stands still while a message is on its way or waits for its reader; then it goes on to the
    next timer. So a run does not depend on how fast the machine is. With `wall_clock` it goes on
    by itself, for a run with nodes in other processes.
    """

    def __init__(self, plan: RunPlan, folder: Path, *, wall_clock: bool = False) -> None:
        """Prepare for the bag of `plan` in `folder`; `add` and `add_all` build the nodes."""
        folder.mkdir(parents=True, exist_ok=True)
        self.folder = folder
        self.time = None if wall_clock else SteppedTime()
        self._specs = nodes_of(shift=plan.settings.shift)
        self.parameters = plan.node_parameters(folder, folder)
        self.nodes: dict[str, GraphNode] = {}
        self.context = Context()
        rclpy.init(args=[], context=self.context, signal_handler_options=SignalHandlerOptions.NO)
        self.watch = Node('watch', context=self.context)
        """Node that only looks at the graph."""
        self._others = [self.watch]
        self._executor = make_executor(self.context)
        self._executor.add_node(self.watch)
        self._an_end = Future()
        self._mark_waits = False
        self._has_new_nodes = False

    def __enter__(self) -> 'InProcessGraph':
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Destroy every node, once."""
        if not self.context.ok():
            return
        self._executor.shutdown()
        for node in [*self.nodes.values(), *self._others]:
            node.destroy_node()
        self.context.try_shutdown()

    def parameters_of(self, path: str) -> dict[str, Any]:
        """Return the parameters of a node, of all and its own."""
        return {**self.parameters['*'], **self.parameters.get(path, {})}

    def add_all(self, *, without: Collection[str] = (), **options: Any) -> None:
        """Add every node of the graph that is not there yet and not in `without`."""
        for spec in self._specs:
            if spec.path not in self.nodes and spec.path not in without:
                self.add(spec.path, **options)

    def add(
        self,
        path: str,
        changes: Mapping[str, Any] | None = None,
        *,
        key: str = '',
        **options: Any,
    ) -> GraphNode:
        """Add the node `path` with the run's parameters and `changes`, kept under `key`."""
        values = {**self.parameters_of(path), **(changes or {})}
        overrides = [Parameter(parameter, value=value) for parameter, value in values.items()]
        options = {
            'namespace': node_spec(path).namespace or None,
            'steady_time': self.steady_time(),
            # No test in one process calls a node's services, which take a fifth of its making.
            'start_parameter_services': False,
            **options,
        }
        node = node_class(path)(
            context=self.context,
            parameter_overrides=overrides,
            **options,
        )
        node.done.add_done_callback(lambda _: self._an_end.done() or self._an_end.set_result(None))
        self.nodes[key or path] = node
        self._executor.add_node(node)
        self._has_new_nodes = True
        return node

    def steady_time(self) -> SteadyTime:
        """Return the time for one more node."""
        return self.time or SteadyTime()

    def add_other(self, node: Node) -> None:
        """Add a node that is no part of the product, built with our `context`."""
        self._others.append(node)
        self._executor.add_node(node)
        self._has_new_nodes = True

    def remove(self, name: str) -> None:
        """Remove a node in the middle of the run."""
        node = self.nodes.pop(name)
        node.finish()
        self._executor.remove_node(node)
        node.destroy_node()

    def kill(self, name: str) -> None:
        """Let a node do no more, as one that is killed; the graph still lists it."""
        node = self.nodes.pop(name)
        self._executor.remove_node(node)
        node.finish()
        self._others.append(node)

    def wait_for_publishers(self, topic: str, number: int = 1) -> None:
        """Wait by the wall clock until a topic has publishers, perhaps in another process."""
        wait_until(lambda: self.watch.count_publishers(topic) >= number, topic)

    @property
    def driveline(self) -> DrivelineNode:
        """Driveline of the graph, which `add` or `add_all` has built."""
        node = self.nodes['driveline']
        assert isinstance(node, DrivelineNode)
        return node

    def spin_until(self, condition: Callable[[], bool], what: str) -> None:
        """
        Spin until `condition()` holds; fail when it does not in time or a node failed.

        It is looked at after each callback, so that the graph is no step further than it asks for.
        """
        deadline = self._now() + WITHIN_S
        while not (condition() or self.failures()) and self._now() < deadline:
            if self.time is None:
                self._executor.spin_once(CHECK_PERIOD_S)
            elif not (self._call_next() or self._await_latched() or self.time.step()):
                break
        assert not self.failures(), self.failures()
        assert condition(), f'{what}: not within {WITHIN_S:g} s'

    def run(self) -> None:
        """Spin until the driveline has ended the run, then close every node, the recorder last."""
        self.spin_to_end()
        assert not self.failures(), self.failures()
        self.finish()

    def spin_to_end(self, within_s: float = WITHIN_S) -> None:
        """Spin until the driveline has ended the run or a node failed; fail when neither does."""

        def over() -> bool:
            return self.nodes['driveline'].done.done() or bool(self.failures())

        self._spin_to_an_end(over, 'the end of the run', within_s)

    def finish(self) -> None:
        """Close every node, the recorder last, so that each publishes or writes the rest."""
        for name in sorted(self.nodes, key=lambda name: name == 'recorder'):
            node = self.nodes[name]
            if self.time is None:
                finish_node(self._executor, node)
            else:
                self._drain()
                node.close()
        assert not self.failures(), self.failures()

    def first_failure(self) -> tuple[str, str]:
        """Spin until a node fails; return its name and error message."""
        self._spin_to_an_end(lambda: bool(self.failures()), 'a node that fails', WITHIN_S)
        return next(iter(self.failures().items()))

    def pass_time(self, seconds: float) -> None:
        """Let time pass, and each message arrive when it is sent."""
        assert self.time is not None
        self._await_latched()
        self._drain()
        self.time.advance(seconds, self._drain)

    def failures(self) -> dict[str, str]:
        """Return the error messages of the nodes that have ended with an error, by name."""
        errors = {
            name: node.done.result() for name, node in self.nodes.items() if node.done.done()
        }
        return {name: str(error) for name, error in errors.items() if isinstance(error, DdctError)}

    def _spin_to_an_end(self, ended: Callable[[], bool], what: str, within_s: float) -> None:
        """Spin until `ended()` holds, which the end of a node alone can change."""
        deadline = self._now() + within_s
        while not ended() and self._now() < deadline:
            if self.time is None:
                self._an_end = Future()
                self._executor.spin_until_future_complete(self._an_end, CHECK_PERIOD_S)
            elif not (self._drain() or self._await_latched() or self.time.step()):
                break
        assert ended(), f'{what}: not within {within_s:g} s'

    def _now(self) -> float:
        return time.monotonic() if self.time is None else self.time.monotonic()

    def _drain(self) -> bool:
        """Let every message arrive, and those that follow; return whether a node has ended."""
        self._an_end = Future()
        self._executor.spin_until_future_complete(self._an_end, 0.0)
        return self._an_end.done()

    def _await_latched(self) -> bool:
        """
        Wait until new nodes have the latched messages of others; return False where none is new.

        Fast DDS hands these on by its own timers, in tens of milliseconds of the wall clock.
        """
        waits, self._has_new_nodes = self._has_new_nodes, False
        for node in [*self.nodes.values(), *self._others] if waits else ():
            for publisher in node.publishers:
                if publisher.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL:
                    assert publisher.wait_for_all_acked(Duration(seconds=WITHIN_S))
        return waits

    def _call_next(self) -> bool:
        """Make the next callback that waits; return False where none waits."""
        # The first may only have made the executor notice what is new in a node.
        return self._call_one() or self._call_one()

    def _call_one(self) -> bool:
        marks = not self._mark_waits
        if marks:
            self._mark_waits = True
            self._executor.create_task(self._take_mark)
        self._executor.spin_once(0.0)
        # Callbacks are made in the order in which they came: where the mark is next, none waits.
        return not marks or self._mark_waits

    def _take_mark(self) -> None:
        self._mark_waits = False


def by_hand(graph: InProcessGraph, settings: Mapping[str, Any]) -> InProcessGraph:
    """
    Give the nodes of a graph settings by their parameters in place of files, as a user would.

    Those of the plant and the recorder get all, those that control none that they do not have.
    """
    known = {key: settings[key] for key in settings if key not in OF_CASE}
    graph.parameters['*'].pop('known')
    for path in ('controller', 'reference', 'handover'):
        graph.parameters.setdefault(path, {}).update(known)
    for parameters in graph.parameters.values():
        if parameters.pop('case', None):
            parameters.update(settings)
    return graph


GraphOf = Callable[..., InProcessGraph]
"""Type of the fixture `graph_of`: a function of a plan that prepares its graph."""
