# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Plausible stamps in real time, judged by a steady clock; independent of ROS."""

from collections.abc import Callable, Collection

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_NS, START_NS, step_of_stamp

TICK_LEAD_NS = 300_000_000
"""Largest lead in ns of a tick over the time since the first one: a late subscriber may
have ten ticks in its queue (0.1 s), and the clocks of two machines drift by 0.2 s in an hour."""


class StampLimit:
    """
    Refuse stamps that no tick can have reached yet.

    A tick may be late by any time: a node that was suspended finds its queue full, and the steady
    clock went on meanwhile. It may be early by at most `TICK_LEAD_NS`, counted from the first
    received tick, which is normally t_0. A reply may be one period ahead of the present tick, as
    estimated from the ticks that were on time.
    """

    def __init__(
        self,
        ticks: Collection[str],
        clock_ns: Callable[[], int],
        *,
        from_t0: bool = False,
        shown: Callable[[str], str] = str,
    ) -> None:
        """
        Limit the stamps of `ticks`, the topics that the owner of time publishes, and of replies.

        All other topics are replies to ticks. `clock_ns` is a steady clock in ns. With `from_t0`
        a first tick later than t_0 is refused. `shown` returns the name of a topic in a refusal.
        """
        self._ticks = ticks
        self._clock_ns = clock_ns
        self._from_t0 = from_t0
        self._shown = shown
        self._first: tuple[int, int] | None = None
        """Stamp of the first tick in ns, and the clock in ns at which it was received."""
        self._lead_ns: int | None = None
        """Largest stamp less clock, in ns, of the ticks after the first, which is the start
        barrier."""

    @property
    def tick_received(self) -> bool:
        """Whether any tick was received."""
        return self._first is not None

    def why_refused(self, topic: str, stamp_ns: int) -> str:
        """Return why a message with this stamp is refused now, or ''; note an accepted tick."""
        try:
            step_of_stamp(stamp_ns)
        except DdctError as error:
            return f'{self._shown(topic)}: {error}'
        now = self._clock_ns()
        is_tick = topic in self._ticks
        latest = self._latest_tick(now) if is_tick else self._latest_reply(now)
        if latest is not None and stamp_ns > latest:
            return (
                f'{self._shown(topic)}: stamp {stamp_ns} ns is {(stamp_ns - latest) / 1e9:.3g} s '
                'ahead of what can be due: stamp the message with the tick it answers'
            )
        if is_tick:
            self._note_tick(stamp_ns, now)
        return ''

    def _latest_tick(self, now: int) -> int | None:
        if self._first is None:
            return START_NS if self._from_t0 else None
        stamp, received_ns = self._first
        return stamp + now - received_ns + TICK_LEAD_NS

    def _latest_reply(self, now: int) -> int:
        if self._lead_ns is not None:
            return self._lead_ns + now + PERIOD_NS
        return (START_NS if self._first is None else self._first[0]) + PERIOD_NS

    def _note_tick(self, stamp_ns: int, now: int) -> None:
        if self._first is None or stamp_ns < self._first[0]:
            # Stamps of ticks never decrease: a lower one shows that the first message was no tick.
            self._first, self._lead_ns = (stamp_ns, now), None
        elif stamp_ns > self._first[0]:
            lead = stamp_ns - now
            self._lead_ns = lead if self._lead_ns is None else max(self._lead_ns, lead)
