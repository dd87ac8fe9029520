# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nodes of the graph inside the test's process; a test can leave out, replace or add some."""

import importlib
import time
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import Any

import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future

from ddct_bringup.processes.graph_nodes import NodeSpec, nodes_of
from ddct_bringup.run.plan import RunPlan
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.spin import finish_node, make_executor
from ddct_plant.nodes.driveline_node import DrivelineNode

CHECK_PERIOD_S = 0.001
"""Period of the checks of a condition while the graph spins, s."""


def node_spec(path: str) -> NodeSpec:
    """Return the description of the node with this full name within its graph."""
    return next(spec for spec in nodes_of(shift=True) if spec.path == path)


def node_class(path: str) -> type[GraphNode]:
    """Return the class of the node with this full name within its graph."""
    spec = node_spec(path)
    return getattr(importlib.import_module(spec.module), spec.class_name)


class InProcessGraph:
    """Nodes of one run on one executor; as a context manager it destroys them."""

    def __init__(self, plan: RunPlan, folder: Path) -> None:
        """Prepare for the bag of `plan` in `folder`; `add` and `add_all` build the nodes."""
        folder.mkdir(parents=True, exist_ok=True)
        self.folder = folder
        self._specs = nodes_of(shift=plan.settings.shift)
        self.parameters = plan.node_parameters(folder, folder)
        self.nodes: dict[str, GraphNode] = {}
        self.context = Context()
        rclpy.init(args=[], context=self.context, signal_handler_options=SignalHandlerOptions.NO)
        self._watch = Node('watch', context=self.context)
        self._others = [self._watch]
        self._executor = make_executor(self.context)
        self._executor.add_node(self._watch)

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
        values = {**self.parameters['*'], **self.parameters.get(path, {}), **(changes or {})}
        overrides = [Parameter(parameter, value=value) for parameter, value in values.items()]
        options = {'namespace': node_spec(path).namespace or None, **options}
        node = node_class(path)(context=self.context, parameter_overrides=overrides, **options)
        self.nodes[key or path] = node
        self._executor.add_node(node)
        return node

    def add_other(self, node: Node) -> None:
        """Add a node that is no part of the product, built with our `context`."""
        self._others.append(node)
        self._executor.add_node(node)

    def remove(self, name: str) -> None:
        """Remove a node in the middle of the run."""
        node = self.nodes.pop(name)
        node.finish()
        self._executor.remove_node(node)
        node.destroy_node()

    def wait_for_publisher(self, topic: str, within_s: float) -> None:
        """Spin until `topic` has a publisher, perhaps in another process."""
        self.spin_until(lambda: bool(self._watch.count_publishers(topic)), topic, within_s)

    @property
    def driveline(self) -> DrivelineNode:
        """Driveline of the graph, which `add` or `add_all` has built."""
        node = self.nodes['driveline']
        assert isinstance(node, DrivelineNode)
        return node

    def spin_until(self, condition: Callable[[], bool], what: str, within_s: float = 30) -> None:
        """
        Spin until `condition()` holds; fail when it does not in time or a node failed.

        It is looked at after each callback, so that the graph is no step further than it asks for.
        """
        deadline = time.monotonic() + within_s
        while not (condition() or self.failures()) and time.monotonic() < deadline:
            self._executor.spin_once(CHECK_PERIOD_S)
        assert not self.failures(), self.failures()
        assert condition(), f'{what}: not within {within_s:g} s'

    def run(self, within_s: float = 30) -> None:
        """Spin until the driveline has ended the run, then close every node, the recorder last."""
        self.spin_to_end(within_s)
        assert not self.failures(), self.failures()
        self.finish()

    def spin_to_end(self, within_s: float = 30) -> None:
        """Spin until the driveline has ended the run or a node failed; fail when neither does."""

        def over() -> bool:
            return self.nodes['driveline'].done.done() or bool(self.failures())

        self._spin_until(over, 'the end of the run', within_s)

    def finish(self) -> None:
        """Close every node, the recorder last, so that each publishes or writes the rest."""
        for name in sorted(self.nodes, key=lambda name: name == 'recorder'):
            finish_node(self._executor, self.nodes[name])
        assert not self.failures(), self.failures()

    def first_failure(self, within_s: float = 30) -> tuple[str, str]:
        """Spin until a node fails; return its name and error message."""
        self._spin_until(lambda: bool(self.failures()), 'a node that fails', within_s)
        return next(iter(self.failures().items()))

    def failures(self) -> dict[str, str]:
        """Return the error messages of the nodes that have ended with an error, by name."""
        errors = {
            name: node.done.result() for name, node in self.nodes.items() if node.done.done()
        }
        return {name: str(error) for name, error in errors.items() if isinstance(error, DdctError)}

    def _spin_until(self, condition: Callable[[], bool], what: str, within_s: float) -> None:
        # A timer checks, because a busy EventsExecutor ignores its timeout; the graph is twice as
        # fast as with a check after each callback.
        met: Future = Future()
        deadline = time.monotonic() + within_s

        def check() -> None:
            if not met.done() and (condition() or time.monotonic() > deadline):
                met.set_result(None)

        steady = Clock(clock_type=ClockType.STEADY_TIME)
        timer = self._watch.create_timer(CHECK_PERIOD_S, check, clock=steady)
        while not met.done():
            self._executor.spin_until_future_complete(met, within_s)
        self._watch.destroy_timer(timer)
        assert condition(), f'{what}: not within {within_s:g} s'


GraphOf = Callable[[RunPlan], InProcessGraph]
"""Type of the fixture `graph_of`: a function that prepares the graph of a plan."""
