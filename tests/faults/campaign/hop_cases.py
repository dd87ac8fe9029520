# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Messages lost, late, doubled and in another order, on each way from a topic to a node."""

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

from faults.campaign.case import CLUTCHES, MODES, Case, run_of
from faults.campaign.graph_runs import graph_run
from faults.campaign.outcome import REFUSED, RUNS_ON, SAME, Observed, Stated, either
from rclpy.clock import Clock, ClockType
from support.hops import inputs_of
from support.in_process_graph import InProcessGraph
from support.relay import Relay, lossy_remaps

from ddct_plant.bag_file.cdr import stamp_of_cdr
from ddct_plant.base.timebase import step_of_stamp
from ddct_plant.signals.topics import TOPICS

DISTURBED_STEPS = 2
"""Steps in which the messages of one topic are disturbed, one topic after the other."""
LATE_S = 0.15
"""Delay in s of a late message: more than the time after which a tick is sent again."""
HOW = ('dropped', 'delayed', 'doubled', 'reordered')


class FaultyHop(Relay):
    """Relay that disturbs the messages of a few steps, each message once."""

    def __init__(self, reader: str, topic: str, how: str, begin: int, **options: Any) -> None:
        """Disturb `topic` on its way to the node `reader` from step `begin` on."""
        message_type = next(each.message_class for each in TOPICS if each.name == topic)
        super().__init__(reader, topic, message_type, lost=0, doubled=0, seed=0, **options)
        self._how = how
        self._steps = set(range(begin, begin + DISTURBED_STEPS))
        self._held: list[bytes] = []
        self._clock_of_delays = Clock(clock_type=ClockType.STEADY_TIME)

    def _hand_on(self, cdr: bytes) -> None:
        send = self._publisher.publish
        step = step_of_stamp(stamp_of_cdr(cdr))
        disturbed = step in self._steps
        self._steps.discard(step)
        if not disturbed:
            send(cdr)
            for held in self._held:
                send(held)
            self._held.clear()
        elif self._how == 'doubled':
            send(cdr)
            send(cdr)
            self._held.append(cdr)
        elif self._how == 'reordered':
            self._held.append(cdr)
        elif self._how == 'delayed':
            self._send_later(cdr)

    def _send_later(self, cdr: bytes) -> None:
        def send() -> None:
            timer.cancel()
            self._publisher.publish(cdr)

        timer = self.create_timer(LATE_S, send, clock=self._clock_of_delays)


def disturb(how: str, readers: Sequence[str], case: Case, folder: Path) -> Observed:
    """Record a run in which the messages of each topic on its way to nodes are disturbed."""
    ways = inputs_of(case.run)

    hops = [(reader, topic) for reader in readers for topic in ways[reader]]
    last = case.steps - DISTURBED_STEPS
    begins = [(case.begin + number * DISTURBED_STEPS) % last for number in range(len(hops))]

    def arrange(graph: InProcessGraph) -> None:
        for reader in readers:
            graph.add(reader, cli_args=lossy_remaps(reader, ways[reader]))
        for (reader, topic), begin in zip(hops, begins, strict=True):
            graph.add_other(FaultyHop(reader, topic, how, begin, context=graph.context))

    return graph_run(case, folder, arrange, min(begins))


def cases() -> Iterator[Case]:
    """Yield each fault for each node, and in real time also for all nodes at once."""
    for clutches, how, mode in product(CLUTCHES, HOW, MODES):
        readers = list(inputs_of(run_of(mode, clutches)))
        for reader in readers:
            common = (f'each topic to {reader}', 'middle', mode, clutches)
            stated = SAME if mode == 'lockstep' else _counted(reader, how)
            yield Case(f'message {how}', *common, stated, partial(disturb, how, [reader]))
        if mode == 'realtime':
            every = ('each topic to each node', 'all along', mode, clutches)
            stated = _counted('recorder', how)
            yield Case(f'message {how}', *every, stated, partial(disturb, how, readers))


def _counted(reader: str, how: str) -> Stated:
    """Return what follows in real time; only what the recorder lacks is not in the recording."""
    return either(RUNS_ON, REFUSED) if (reader, how) == ('recorder', 'dropped') else RUNS_ON
