# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""One reply per stamp, repeated on request; does not depend on ROS."""

from collections.abc import Callable
from typing import Any

from ddct_plant.ticks.join import JoinResult, StampJoin


class StampReplies:
    """
    Answer each complete stamp once; when the trigger comes again, publish the last reply again.

    A trigger that comes again with other values shows that two nodes publish its topic. What then
    follows is up to `dispute`.
    """

    def __init__(
        self,
        join: StampJoin,
        answer: Callable[[int, int, dict[str, object]], None],
        publish: Callable[[], None],
        dispute: Callable[[str, int], None],
    ) -> None:
        """
        Reply to the complete stamps of `join`.

        `answer(step, stamp_ns, inputs)` computes and keeps the reply to the values of one stamp,
        by topic; `publish()` publishes the kept reply; `dispute(topic, stamp_ns)` is called when
        the trigger has come again with other values.
        """
        self._join = join
        self._answer = answer
        self._publish = publish
        self._dispute = dispute
        self._answered: Any = None

    def receive(self, topic: str, stamp_ns: int, values: Any) -> None:
        """Take the values of one message; raise the errors of `StampJoin.offer` and `answer`."""
        result = self._join.offer(topic, stamp_ns, values)
        if result is JoinResult.COMPLETE:
            step, inputs = self._join.take()
            self._answered = inputs[self._join.topics[0]]
            self._answer(step, stamp_ns, inputs)
            self._publish()
        elif result is JoinResult.REPEAT:
            if values != self._answered:
                self._dispute(topic, stamp_ns)
            else:
                self._publish()
        elif result is JoinResult.BEGUN_ANEW:
            self._publish()
