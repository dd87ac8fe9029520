# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A follower repeats its reply for a repeated tick; another message for it is a fault."""

import pytest

pytest.importorskip('rclpy')

from types import SimpleNamespace  # noqa: E402
from typing import Any  # noqa: E402

from ddct_plant.base.errors import DdctError  # noqa: E402
from ddct_plant.base.timebase import stamp_of_step  # noqa: E402
from ddct_plant.graph import follower  # noqa: E402
from ddct_plant.signals.topics import ENGINE_REQUEST, JOINT_STATES

TRIGGER, OTHER = JOINT_STATES.name, ENGINE_REQUEST.name


class Sum(follower.FollowerNode):
    """Answers with the sum of its two inputs; no node of ROS."""

    def __init__(self) -> None:
        self.known: Any = SimpleNamespace(lockstep=True)
        self.answers: list[float] = []
        self.published = 0
        self.follow(JOINT_STATES, ENGINE_REQUEST)

    def subscribe_values(self, *_: Any) -> None:
        """Subscribe to nothing: the tests pass messages in."""

    def log_start(self, *_: Any, **__: Any) -> None:
        """Log nothing: there is no graph that has names."""

    def get_namespace(self) -> str:
        return '/off_going'

    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> follower.Reply:
        self.answers.append(inputs[TRIGGER] + inputs[OTHER])
        return ()

    def publish_reply(self) -> None:
        self.published += 1


@pytest.fixture
def node(monkeypatch):
    monkeypatch.setattr(follower, 'publishers_of', lambda *_: '/one and /two')
    node = Sum()
    node._receive(TRIGGER, stamp_of_step(0), 3.0)
    node._receive(OTHER, stamp_of_step(0), 4.0)
    assert (node.answers, node.published) == ([7.0], 1)
    return node


def test_the_same_tick_again_is_answered_again_and_not_computed_again(node):
    node._receive(TRIGGER, stamp_of_step(0), 3.0)
    assert (node.answers, node.published) == ([7.0], 2)


def test_another_tick_of_the_same_stamp_is_a_second_publisher(node):
    """
    The messages of the tick alone are compared, whatever the value of the other input is.

    The error names the topic as the graph does.
    """
    with pytest.raises(
        DdctError, match=f'^off_going/{TRIGGER} carries two different messages .* /two: stop'
    ):
        node._receive(TRIGGER, stamp_of_step(0), 4.0)
    assert node.published == 1
