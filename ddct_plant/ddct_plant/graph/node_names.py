# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Names of nodes in `run_info`, diagnostics, bags and scores: full ones, as '/off_going/actuator'.

A bag has nodes and topics as if its graph were in no namespace, so that one recorded in
'/car7/powertrain' has the same bytes as one in '/'.
"""

from typing import NamedTuple


def name_in_graph(node: str, namespace: str = '/') -> str:
    """
    Return the full name of a node relative to the namespace of its graph.

    A name without a slash, as in earlier bags, is that of a node in the namespace itself.
    A node outside of the namespace keeps its full name.
    """
    if not node.startswith('/'):
        return f'/{node}'
    return f'/{node.removeprefix(namespace.rstrip("/") + "/").removeprefix("/")}'


class StatusName(NamedTuple):
    """Name of a status on `/diagnostics`: the node, and what of it the status describes."""

    node: str
    """Full name of the node; '' in a name without one."""
    what: str
    """Ending of the name, as ': ticks'; the whole name in one without a node."""

    @classmethod
    def of(cls, name: str, namespace: str = '/') -> 'StatusName':
        """Return the parts of a name, the node relative to the namespace of its graph."""
        node, separator, what = name.rpartition(': ')
        if not separator:
            return cls('', name)
        return cls(name_in_graph(node, namespace), separator + what)

    def __str__(self) -> str:
        return f'{self.node}{self.what}'
