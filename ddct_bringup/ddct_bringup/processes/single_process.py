# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Run all nodes of the graph in this process, on one executor."""

import gc
import importlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from rclpy.context import Context
from rclpy.parameter import Parameter

from ddct_bringup.processes.graph_nodes import NodeSpec
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.arguments import init_ros
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.spin import end_of, finish_node, make_executor, spin_until
from ddct_plant.program.scheduling import scheduling_restored


def run_single_process(
    specs: Sequence[NodeSpec],
    parameters: Mapping[str, Mapping[str, Any]],
    stopped: Callable[[], bool],
) -> None:
    """
    Run the node classes of the separate processes until the driveline has ended the run.

    `specs` are the nodes of the run; `parameters` are by node path, those of '*' for all. Raise
    DdctError when a node fails and KeyboardInterrupt when `stopped()` becomes true.
    """
    context = Context()
    init_ros([], context)
    nodes: list[GraphNode] = []
    try:
        with scheduling_restored():
            for spec in specs:
                nodes.append(_build(spec, parameters, context))
            _spin(nodes, context, stopped)
    finally:
        while nodes:
            nodes.pop(0).destroy_node()
        context.try_shutdown()
        # Nodes refer to one another, and compiled code of others runs until its node is collected.
        gc.collect()


def _build(
    spec: NodeSpec, parameters: Mapping[str, Mapping[str, Any]], context: Context
) -> GraphNode:
    node_class = getattr(importlib.import_module(spec.module), spec.class_name)
    values = {**parameters['*'], **parameters.get(spec.path, {})}
    overrides = [Parameter(name, value=value) for name, value in values.items()]
    try:
        return node_class(
            context=context, parameter_overrides=overrides, namespace=spec.namespace or None
        )
    except DdctError as error:
        raise DdctError(f'node {spec.path}: {error}') from error


def _spin(nodes: list[GraphNode], context: Context, stopped: Callable[[], bool]) -> None:
    executor = make_executor(context)
    try:
        for node in nodes:
            executor.add_node(node)
        spin_until(executor, end_of(nodes, stopped))
        interrupted = not any(node.done.done() for node in nodes)
        # The last one, driveline, owns time: without it the others have nothing more to do.
        nodes[-1].finish()
        failed = [node for node in nodes if failure(node)]
        # The recorder comes first in the list and must receive what the others publish at the end.
        for node in reversed(nodes):
            if failed:
                node.close()
            else:
                finish_node(executor, node)
    finally:
        # Otherwise the nodes and their latched messages stay in the domain of the next run.
        executor.shutdown()
    # The first failure made other nodes fail when they were closed.
    for node in [*failed, *nodes]:
        error = failure(node)
        if error is not None:
            raise DdctError(f'node {node.get_fully_qualified_name()[1:]}: {error}')
    if interrupted:
        raise KeyboardInterrupt


def failure(node: GraphNode) -> DdctError | None:
    """Return the error that ended the node, or None while it runs or when it ended well."""
    return node.done.result() if node.done.done() else None
