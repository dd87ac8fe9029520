# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What excludes a second live publisher of a topic that the graph lists twice."""

import pytest

pytest.importorskip('rclpy')

from types import SimpleNamespace  # noqa: E402
from typing import Any  # noqa: E402

from ddct_plant.graph.sole_publishers import (  # noqa: E402
    CHECK_S,
    PROOF_S,
    SILENCE_S,
    SolePublishers,
    _Probe,
)
from ddct_plant.signals.topics import JOINT_STATES  # noqa: E402

PERIOD_S = 0.125
"""Period of the checks here, whose sums are exact."""


def seconds_to_exclude_two(*, messages: bool) -> float:
    """Return the time in s after which one publisher that sends, or none, excludes two."""
    now_s = [0.0]
    arrived: list[int] = []

    def take_message(*_: object) -> tuple[None, dict[str, int]] | None:
        return (None, {'publication_sequence_number': arrived.pop()}) if arrived else None

    handle = SimpleNamespace(take_message=take_message)
    subscription = SimpleNamespace(handle=handle, msg_type=None)
    node: Any = SimpleNamespace(create_subscription=lambda *_, **__: subscription)
    probe = _Probe(node, JOINT_STATES.name, JOINT_STATES.type, lambda: now_s[0])
    for number in range(1000):
        if probe.excludes_two:
            break
        now_s[0] += PERIOD_S
        arrived += [number] if messages else []
        assert not probe.two_alive()
    return now_s[0]


def test_a_second_of_messages_or_five_of_silence_exclude_a_second_publisher():
    assert PERIOD_S < CHECK_S
    assert seconds_to_exclude_two(messages=True) == PROOF_S == 1.0
    assert seconds_to_exclude_two(messages=False) == SILENCE_S == 5.0


def test_a_run_whose_topics_have_one_publisher_each_ends_at_once():
    ended: list[object] = []
    node: Any = SimpleNamespace(
        steady_time=SimpleNamespace(monotonic=lambda: 0.0),
        resolve_topic_name=lambda name: f'/{name}',
        every=lambda *_: None,
        count_publishers=lambda _: 1,
        get_publishers_info_by_topic=lambda _: [],
        finish=ended.append,
    )
    SolePublishers(node, lambda: None).finish()
    assert ended == [None]
