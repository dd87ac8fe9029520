# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""How far a reply of a real-time run may be ahead of the ticks; independent of ROS."""

from collections.abc import Callable, Collection

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import step_of_stamp
from ddct_plant.ticks.join import MOST_WAITING


class ReplyLimit:
    """
    Refuse replies too far ahead to answer any tick; they would switch off a fail-safe.

    A reply may be read before its tick, which then waits in another queue, so it may be
    `MOST_WAITING` steps ahead of the newest tick. Ticks are not limited: after a pause the next
    one may be any number of steps later.
    """

    def __init__(self, ticks: Collection[str], shown: Callable[[str], str] = str) -> None:
        """
        Take the topics that the owner of time publishes; all others are replies.

        `shown` returns the name of a topic in a refusal.
        """
        self._ticks = ticks
        self._shown = shown
        self.newest: int | None = None
        """Step of the newest tick that was received; None before the first one."""

    def why_refused(self, topic: str, stamp_ns: int) -> str:
        """Return why a message with this stamp is refused now, or ''; note a tick."""
        try:
            step = step_of_stamp(stamp_ns)
        except DdctError as error:
            return f'{self._shown(topic)}: {error}'
        if topic in self._ticks:
            self.newest = max(step, self.newest or 0)
        elif step > (ahead_of := self.newest or 0) + MOST_WAITING:
            return (
                f'{self._shown(topic)}: stamp {stamp_ns} ns is {step - ahead_of} steps ahead of '
                'the ticks: stamp the message with the tick that it answers'
            )
        return ''
