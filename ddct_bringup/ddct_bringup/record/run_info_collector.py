# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Collector of `run_info`: the nodes received so far, and whether their settings agree."""

from collections.abc import Collection, Mapping

from ddct_bringup.bag.run_info import (
    CONTROLLER_NODE,
    DRIVELINE_NODE,
    RunInfoOfNodes,
    add_run_info,
    run_info_order,
    run_info_topic,
)
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.node_names import name_in_graph
from ddct_plant.graph.node_reports import (
    CONTROL_NODES,
    CONTROLLER,
    PARTS,
    ROLE,
    STEPS,
    TWO_INPUT,
    flag,
    run_info_pairs,
    settings_of_node,
)
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.shift.roles import OFF_GOING, ON_COMING
from ddct_plant.signals.topics import OFF_GOING_RUN_INFO, RUN_INFO


class RunInfoCollector:
    """Collector of the `run_info` of every node that a recording needs."""

    def __init__(self, settings: RunSettings, two_input: bool, expected: Collection[str]) -> None:
        """
        Store the recorder's own settings, and the names of the nodes to wait for.

        A name without a slash is that of a node in the recorder's own namespace.
        """
        self._settings = settings
        self._two_input = flag(two_input)
        self._expected = {name_in_graph(node) for node in expected}
        self._received: RunInfoOfNodes = {}

    def receive(self, node: str, pairs: Mapping[str, str]) -> None:
        """
        Store the `run_info` of a node, given by its full name.

        Raise DdctError when its settings differ from the recorder's, or its pairs from
        earlier ones.
        """
        for key, ours in run_info_pairs(settings_of_node(self._settings, node)).items():
            if pairs.get(key, ours) != ours:
                raise DdctError(
                    f'node {node} runs with {key} {pairs[key]} and the recorder with {ours}'
                    f'{" for its controllers" if node in CONTROL_NODES else ""}: '
                    'start every node with the same settings',
                    key=key,
                )
        if pairs.get(TWO_INPUT, self._two_input) != self._two_input:
            raise DdctError(
                f'node {node} runs with two_input {pairs[TWO_INPUT]} and the recorder with '
                f'{self._two_input}: start engine and recorder with the two_input of the '
                'controller, as --ros-args -p two_input:=true when it commands the engine',
                key=TWO_INPUT,
            )
        self._require_role(node, pairs)
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

    def _require_role(self, node: str, pairs: Mapping[str, str]) -> None:
        """Raise DdctError for a side of a gear shift other than that of the node's namespace."""
        place = OFF_GOING if run_info_topic(node) is OFF_GOING_RUN_INFO else ON_COMING
        if pairs.get(ROLE, place) != place:
            raise DdctError(
                f'node {node} has the role {pairs[ROLE]}, but its name is that of the {place} '
                f'side: start it with --ros-args -p role:={place}, or in another namespace'
            )

    def _value(self, node: str, key: str) -> str:
        pairs = self._received.get(node, {})
        if key not in pairs:
            raise DdctError(
                f'{RUN_INFO.name} of node {node} has no {key}, which the bag needs: whoever '
                f'stands in for {node} must publish it',
                key=key,
            )
        return pairs[key]
