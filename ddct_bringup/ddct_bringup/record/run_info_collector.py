# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Collector of `run_info`: the nodes received so far, and what the bag takes from them."""

from collections.abc import Collection, Mapping

from ddct_bringup.bag.run_info import (
    CONTROLLER_NODE,
    DRIVELINE_NODE,
    RunInfoOfNodes,
    add_run_info,
    run_info_order,
)
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.node_names import name_in_graph
from ddct_plant.graph.node_reports import CONTROLLER, PARTS, STEPS, flag
from ddct_plant.signals.topics import RUN_INFO


class RunInfoCollector:
    """Collector of the `run_info` of every node that a recording needs."""

    def __init__(self, expected: Collection[str]) -> None:
        """
        Store the names of the nodes to wait for.

        A name without a slash is that of a node in the recorder's own namespace.
        """
        self._expected = {name_in_graph(node) for node in expected}
        self._received: RunInfoOfNodes = {}

    def receive(self, node: str, pairs: Mapping[str, str]) -> None:
        """
        Store the `run_info` of a node, given by its full name.

        Raise DdctError when two nodes have this name.
        """
        add_run_info(self._received, node, pairs)

    def missing(self) -> list[str]:
        """Return the names of the expected nodes whose `run_info` has not been received."""
        return sorted(self._expected - set(self._received))

    def has(self, node: str) -> bool:
        """Return whether a node, given by its full name, belongs to the recorded graph."""
        return node in self._expected or node in self._received

    def received(self) -> RunInfoOfNodes:
        """Return the received `run_info` by node name, in the order in which it is recorded."""
        return {node: self._received[node] for node in run_info_order(self._received)}

    @property
    def controller(self) -> str:
        """Name of the controller; DdctError when no node has published it."""
        return self._value(CONTROLLER_NODE, CONTROLLER)

    @property
    def steps(self) -> int:
        """N, the number of periods; DdctError when the driveline has not published it."""
        steps = self._value(DRIVELINE_NODE, STEPS)
        if not steps.isdecimal():
            raise DdctError(
                f'{RUN_INFO.name} of node {DRIVELINE_NODE} has steps {steps!r}: '
                'give a whole number',
                key='steps',
            )
        return int(steps)

    @property
    def torque_parts(self) -> bool | None:
        """
        Whether the controller's node publishes the parts of its request; None before its run_info.

        DdctError for a text that is no flag.
        """
        pairs = self._received.get(CONTROLLER_NODE)
        if pairs is None:
            return None
        text = pairs.get(PARTS, flag(False))
        if text not in (flag(True), flag(False)):
            raise DdctError(
                f'{RUN_INFO.name} of node {CONTROLLER_NODE} has {PARTS} {text!r}: give true where '
                'it publishes controller/torque_parts, or leave the key out',
                key=PARTS,
            )
        return text == flag(True)

    def _value(self, node: str, key: str) -> str:
        pairs = self._received.get(node, {})
        if key not in pairs:
            raise DdctError(
                f'{RUN_INFO.name} of node {node} has no {key}, which the bag needs: a node '
                f'in place of {node} must publish it too',
                key=key,
            )
        return pairs[key]
