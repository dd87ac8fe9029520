# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Names of nodes in `run_info`, diagnostics, bags and scores: full ones, as '/off_going/actuator'.

A bag has nodes and topics as if its graph were in no namespace, so that one recorded in
'/car7/powertrain' has the same bytes as one in '/'. Errors name topics in the same way.
"""

from typing import NamedTuple

from ddct_plant.shift.roles import OFF_GOING


def name_in_graph(node: str, namespace: str = '/') -> str:
    """
    Return the full name of a node relative to the namespace of its graph.

    A name without a slash, as in earlier bags, is that of a node in the namespace itself.
    A node outside of the namespace keeps its full name.
    """
    if not node.startswith('/'):
        return f'/{node}'
    return f'/{node.removeprefix(namespace.rstrip("/") + "/").removeprefix("/")}'


def topic_in_graph(topic: str, namespace: str) -> str:
    """
    Return the name of a topic in the namespace of its graph, as in the table of the topics.

    `topic` is the name that a node in `namespace` uses. Only the nodes of the off-going side are
    in a namespace within that of the graph.
    """
    if topic.startswith('/') or namespace.rpartition('/')[2] != OFF_GOING:
        return topic
    return f'{OFF_GOING}/{topic}'


class StatusName(NamedTuple):
    """Name of a status on `/diagnostics`: the node, and what of it the status describes."""

    node: str
    """Full name of the node; '' in a name without one."""
    what: str
    """Ending of the name, as ': ticks'; the whole name in one without a node."""

    @classmethod
    def of(cls, name: str, namespace: str = '/') -> 'StatusName':
        """
        Return the parts of a name, the node relative to the namespace of its graph.

        A node outside of the namespace is none of the graph: the name then has no node.
        """
        node, separator, what = name.rpartition(': ')
        inside = f'{namespace.rstrip("/")}/'
        if not separator or (node.startswith('/') and not node.startswith(inside)):
            return cls('', name)
        return cls(name_in_graph(node, namespace), separator + what)

    def __str__(self) -> str:
        return f'{self.node}{self.what}'
