# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Names of a graph in ROS: its namespace, and topics that a user has renamed."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import close_name
from ddct_plant.program.command_line import ROS_ARGUMENTS
from ddct_plant.signals.topics import TOPICS

_NAMESPACE = '__ns'
_REMAP = ('-r', '--remap')
_OF_ROS = ('/parameter_events', '/rosout')
"""Topics that each node has besides those of the graph."""
_FULL_NAME = re.compile(r'(/[A-Za-z](_?[A-Za-z0-9])*_?)+')
_FORM = (
    f'give {ROS_ARGUMENTS} -r __ns:=/NAMESPACE, or -r /TOPIC:=/OTHER with full names; other '
    'settings of the nodes are options of the run'
)


@dataclass(frozen=True)
class GraphNames:
    """Names of the nodes and topics of one graph beside those that they have by default."""

    namespace: str = ''
    """Namespace of the graph, as '/car'; empty for the root."""
    topics: tuple[tuple[str, str], ...] = ()
    """Full names of topics and their new names, as ('/clock', '/car/clock')."""

    @classmethod
    def of(cls, arguments: Sequence[str]) -> 'GraphNames':
        """
        Return the names that remaps give, as ['-r', '__ns:=/car', '-r', '/clock:=/car/clock'].

        Full names alone mean the same for every node: those of the off-going side have a
        namespace within that of the graph. Raise ParameterError for anything else.
        """
        if len(arguments) % 2 or any(flag not in _REMAP for flag in arguments[::2]):
            raise ParameterError(
                f'{ROS_ARGUMENTS} {" ".join(arguments)}: {_FORM}', key=ROS_ARGUMENTS
            )
        namespace, topics = '', []
        for rule in arguments[1::2]:
            old, _, new = rule.partition(':=')
            if not _FULL_NAME.fullmatch(new) or (
                old != _NAMESPACE and not _FULL_NAME.fullmatch(old)
            ):
                raise ParameterError(f'{ROS_ARGUMENTS} -r {rule}: {_FORM}', key=ROS_ARGUMENTS)
            if old == _NAMESPACE:
                namespace = new
            else:
                topics.append((old, new))
        names = [topic.name for topic in TOPICS]
        known = [each if each[0] == '/' else f'{namespace}/{each}' for each in names]
        for old, _ in topics:
            if old not in (*known, *_OF_ROS):
                raise ParameterError(
                    f'{ROS_ARGUMENTS} -r: no topic {old}: {close_name(old, known)}',
                    key=ROS_ARGUMENTS,
                )
        return cls(namespace, tuple(topics))

    def resolved(self, topic: str) -> str:
        """Return the new name of a topic, given by its full name; the first rule for it counts."""
        return dict(reversed(self.topics)).get(topic, topic)

    def remaps(self, inner: str = '') -> list[str]:
        """Return the ROS arguments of a node in the namespace `inner` within the graph's."""
        space = f'{self.namespace}/{inner}' if inner else self.namespace
        rules = [(_NAMESPACE, space)] if space else []
        return [each for old, new in (*rules, *self.topics) for each in ('-r', f'{old}:={new}')]
