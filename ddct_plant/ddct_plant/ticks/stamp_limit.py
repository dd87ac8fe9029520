"""Which stamps can be true in real time, by a steady clock; knows nothing of ROS."""

import time
from collections.abc import Callable, Collection

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_NS, START_NS, step_of_stamp

TICK_LEAD_NS = 300_000_000
"""How far ticks may run ahead of the time since the first one: a reader that starts late may have
ten ticks in its queue (0.1 s), and the clocks of two machines part by 0.2 s in an hour."""


class StampLimit:
    """
    Refuse stamps that no tick can have reached yet.

    A tick may be as late as it likes: a node that was stopped finds its queue full of them, and
    the steady clock went on meanwhile. Ahead of time, it may be by `TICK_LEAD_NS` since the first
    tick that was seen, t_0 as a rule. A reply may be one period ahead of where the punctual ticks
    put the driveline by now.
    """

    def __init__(
        self,
        ticks: Collection[str],
        *,
        from_t0: bool = False,
        clock_ns: Callable[[], int] = time.monotonic_ns,
    ) -> None:
        """
        Take the topics that come with every tick from the owner of time, and a clock in ns.

        The clock is a steady one. All other topics reply to ticks. `from_t0` refuses to begin
        with a later tick than t_0.
        """
        self._ticks = ticks
        self._clock_ns = clock_ns
        self._from_t0 = from_t0
        self._first: tuple[int, int] | None = None
        """Stamp of the first tick, and when it was seen."""
        self._lead_ns: int | None = None
        """Largest stamp less clock of the ticks after the first, which waits for everybody."""

    @property
    def tick_seen(self) -> bool:
        """Whether there was a tick at all."""
        return self._first is not None

    def why_refused(self, topic: str, stamp_ns: int) -> str:
        """Return why a message with this stamp cannot be true now, or ''; note a true tick."""
        try:
            step_of_stamp(stamp_ns)
        except DdctError as error:
            return f'{topic}: {error}'
        now = self._clock_ns()
        is_tick = topic in self._ticks
        latest = self._latest_tick(now) if is_tick else self._latest_reply(now)
        if latest is not None and stamp_ns > latest:
            return (
                f'{topic}: stamp {stamp_ns} ns is {(stamp_ns - latest) / 1e9:.3g} s ahead of what '
                'can be due: stamp the message with the tick it answers'
            )
        if is_tick:
            self._note_tick(stamp_ns, now)
        return ''

    def _latest_tick(self, now: int) -> int | None:
        if self._first is None:
            return START_NS if self._from_t0 else None
        stamp, seen = self._first
        return stamp + now - seen + TICK_LEAD_NS

    def _latest_reply(self, now: int) -> int:
        if self._lead_ns is not None:
            return self._lead_ns + now + PERIOD_NS
        return (START_NS if self._first is None else self._first[0]) + PERIOD_NS

    def _note_tick(self, stamp_ns: int, now: int) -> None:
        if self._first is None or stamp_ns < self._first[0]:
            # Ticks never fall: a lower one shows that what came first was none.
            self._first, self._lead_ns = (stamp_ns, now), None
        elif stamp_ns > self._first[0]:
            lead = stamp_ns - now
            self._lead_ns = lead if self._lead_ns is None else max(self._lead_ns, lead)
