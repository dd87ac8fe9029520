# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Run all nodes of the graph in this process, on one executor.

This is the process of the program; or one of its own, where compiled code of a third party may end
it: then the program supervises it as if it were a node.
"""

import gc
import importlib
from collections.abc import Callable, Sequence

from rclpy.context import Context

from ddct_bringup.processes.graph_nodes import ALL_NODES, NodeSpec, nodes_of_process
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.arguments import init_ros
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.spin import end_of, finish_node, make_executor, spin_until, watched_stops
from ddct_plant.program.command_line import ROS_ARGUMENTS, run_program
from ddct_plant.program.supervision import announce_exit


def main() -> int:
    """Run all nodes in this process, which a supervisor has started; return its exit code."""

    def program(arguments: list[str]) -> int:
        with watched_stops() as stopped:
            run_single_process(nodes_of_process(arguments), arguments, stopped)
        return 0

    code = 1
    try:
        code = run_program(ALL_NODES, program, None)
    finally:
        announce_exit(code)
    return code


def run_single_process(
    specs: Sequence[NodeSpec], arguments: Sequence[str], stopped: Callable[[], bool]
) -> None:
    """
    Run the node classes of the separate processes until the driveline has ended the run.

    `specs` are the nodes of the run; `arguments` of ROS name the file with their parameters. Raise
    DdctError when a node fails and KeyboardInterrupt when `stopped()` becomes true.
    """
    context = Context()
    init_ros(arguments, context)
    nodes: list[GraphNode] = []
    try:
        for spec in specs:
            if stopped():  # it beats too
                raise KeyboardInterrupt
            nodes.append(_build(spec, context, nodes))
        _spin(nodes, context, stopped)
    finally:
        while nodes:
            nodes.pop(0).destroy_node()
        context.try_shutdown()
        # Nodes refer to one another, and compiled code of others runs until its node is collected.
        gc.collect()


def _build(spec: NodeSpec, context: Context, others: Sequence[GraphNode]) -> GraphNode:
    """Return a node; one with a namespace has it within that of the others."""
    arguments = None
    if spec.namespace:
        graph = others[0].get_namespace().rstrip('/')
        arguments = [ROS_ARGUMENTS, '-r', f'__ns:={graph}/{spec.namespace}']
    node_class = getattr(importlib.import_module(spec.module), spec.class_name)
    try:
        node: GraphNode = node_class(context=context, cli_args=arguments)
    except DdctError as error:
        raise DdctError(f'{spec.title}: {error}') from error
    return node


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
