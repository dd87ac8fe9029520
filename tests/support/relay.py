# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Relays that lose, double and delay messages between the graph's nodes, as a bad network."""

import random
from collections.abc import Iterable
from typing import Any

from rclpy.node import Node

from ddct_plant.graph.qos import RECORDER_QOS

LOSSY = 'lossy'


def lossy_remaps(node: str, topics: Iterable[str]) -> list[str]:
    """
    Return the ROS arguments by which a node receives `topics` only from a `Relay`.

    Node and topics have their names within the graph, which is in no namespace.
    """
    rules = [f'/{topic.lstrip("/")}:=/{_relayed(node, topic)}' for topic in topics]
    return ['--ros-args', *(part for rule in rules for part in ('-r', rule))]


class Relay(Node):
    """Node that forwards one topic to one node; a share of messages is lost, a share doubled."""

    def __init__(
        self,
        reader: str,
        topic: str,
        message_type: type,
        *,
        lost: float,
        doubled: float,
        seed: int,
        **options: Any,
    ) -> None:
        """Forward `topic` to the node `reader`; the shares are between 0 and 1."""
        relayed = _relayed(reader, topic)
        super().__init__(f'relay_{relayed.replace("/", "_")}', **options)
        self.lost = 0
        self.doubled = 0
        self._shares = (lost, doubled)
        self._random = random.Random(f'{seed} {relayed}')
        self._publisher = self.create_publisher(message_type, relayed, RECORDER_QOS)
        self.create_subscription(message_type, topic, self._hand_on, RECORDER_QOS, raw=True)

    def _hand_on(self, cdr: bytes) -> None:
        lost, doubled = self._shares
        if self._random.random() < lost:
            self.lost += 1
            return
        self._publisher.publish(cdr)
        if self._random.random() < doubled:
            self.doubled += 1
            self._publisher.publish(cdr)


def _relayed(reader: str, topic: str) -> str:
    return f'{LOSSY}/{reader}/{topic.lstrip("/")}'
