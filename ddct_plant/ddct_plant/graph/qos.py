# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The QoS profiles of the graph, defined once, and what of them may be overridden.

Each publisher and subscription declares the parameter `qos_overrides.TOPIC.publisher.depth` or
`qos_overrides.TOPIC.subscription.depth`. A deeper queue changes no trajectory. Reliability,
durability and history are not declared: with others, lock-step would wait for lost messages,
late nodes would miss `run_info`, or endpoints would not match at all.
"""

import copy
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial

from rclpy.exceptions import InvalidParameterTypeException
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    QoSPolicyKind,
    QoSProfile,
    ReliabilityPolicy,
)
from rclpy.qos_overriding_options import (
    InvalidQosOverridesError,
    QosCallbackResult,
    QoSOverridingOptions,
)

from ddct_plant.base.errors import ParameterError

LOOP_QOS = QoSProfile(
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.VOLATILE,
    history=HistoryPolicy.KEEP_LAST,
    depth=10,
)
"""QoS of every topic of the control loop."""

LATCHED_QOS = QoSProfile(
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
    history=HistoryPolicy.KEEP_LAST,
    depth=1,
)
"""QoS of `run_info`: one message per node, kept for late subscribers."""

RECORDER_QOS = QoSProfile(
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.VOLATILE,
    history=HistoryPolicy.KEEP_LAST,
    depth=1000,
)
"""QoS of the recorder's subscriptions: a depth at which no burst is lost."""

RECORDER_LATCHED_QOS = QoSProfile(
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
    history=HistoryPolicy.KEEP_LAST,
    depth=1000,
)
"""QoS of the recorder's subscriptions to latched topics."""

LIVE_QOS = QoSProfile(
    reliability=ReliabilityPolicy.BEST_EFFORT,
    durability=DurabilityPolicy.VOLATILE,
    history=HistoryPolicy.KEEP_LAST,
    depth=1000,
)
"""QoS of the live view: best effort, so that no node waits for a viewer or sends to it again."""

QOS_OVERRIDES = 'qos_overrides'
"""Prefix of the parameters with which ROS 2 overrides a profile."""


def own_copy(qos: QoSProfile) -> QoSProfile:
    """Return a copy of a profile, because rclpy writes overrides into the one that it is given."""
    return copy.copy(qos)


def overriding_options(qos: QoSProfile) -> QoSOverridingOptions:
    """Return the options that declare the depth, with that of `qos` as its default and least."""
    return QoSOverridingOptions(
        (QoSPolicyKind.DEPTH,), callback=partial(_require_depth, qos.depth)
    )


def _require_depth(least: int, qos: QoSProfile) -> QosCallbackResult:
    if qos.depth >= least:
        return QosCallbackResult(successful=True)
    return QosCallbackResult(successful=False, reason=f'depth is {qos.depth}, less than {least}')


@contextmanager
def named_override_errors(topic: str) -> Iterator[None]:
    """Raise ParameterError for an override of the QoS of a topic that cannot be used."""
    try:
        yield
    except (InvalidQosOverridesError, InvalidParameterTypeException, ValueError) as error:
        reason = str(error).rpartition('not valid: ')[2]
        raise ParameterError(
            f'{QOS_OVERRIDES} of {topic}: {reason}: give a whole number of at least the default',
            key=topic,
        ) from error
