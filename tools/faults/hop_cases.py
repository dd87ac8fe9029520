# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Messages lost, late, doubled and in another order, on each way from a topic to a node."""

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path

from support.altering import AlteringNode, add_altering, remaps
from support.hops import inputs_of
from support.in_process_graph import InProcessGraph

from faults.case import Case, Where, places
from faults.graph_runs import graph_run
from faults.outcome import REFUSED, RUNS_ON, SAME, Observed, either

DISTURBED_STEPS = 2
"""Steps in which the messages of one topic are disturbed, one topic after the other."""
LATE_S = 0.15
"""Delay in s of a late message: more than the time after which a tick is sent again."""
EACH = 'each node'
DISTURBED: dict[str, Where] = {
    'dropped': {
        ('middle', 'lockstep', 1): ('driveline', 'controller', 'recorder'),
        ('all along', 'realtime', 1): (EACH,),
        ('all along', 'realtime', 2): (EACH,),
        ('middle', 'realtime', 1): ('recorder',),
    },
    'delayed': {
        ('middle', 'lockstep', 1): ('controller',),
        ('all along', 'realtime', 1): (EACH,),
        ('middle', 'realtime', 1): ('recorder',),
    },
    'doubled': {
        ('middle', 'lockstep', 1): ('driveline',),
        ('all along', 'realtime', 1): (EACH,),
    },
    'reordered': {
        ('middle', 'lockstep', 1): ('recorder',),
        ('middle', 'lockstep', 2): ('handover',),
        ('all along', 'realtime', 1): (EACH,),
    },
}
"""Readers by what happens to their messages: a join, the owner of time, the bag, all of them."""


class Disturbance:
    """What happens to the messages of a few steps, to each message once."""

    def __init__(self, how: str, begin: int) -> None:
        """Disturb from step `begin` on."""
        self._how = how
        self._steps = set(range(begin, begin + DISTURBED_STEPS))
        self._held: list[bytes] = []

    def __call__(self, node: AlteringNode, step: int, cdr: bytes) -> None:
        """Hand a message on, or not."""
        disturbed = step in self._steps
        self._steps.discard(step)
        if not disturbed:
            for each in (cdr, *self._held):
                node.send(each)
            self._held.clear()
        elif self._how == 'doubled':
            node.send(cdr)
            node.send(cdr)
            self._held.append(cdr)
        elif self._how == 'reordered':
            self._held.append(cdr)
        elif self._how == 'delayed':
            node.send_later(cdr, LATE_S)


def disturb(how: str, reader: str, case: Case, folder: Path) -> Observed:
    """Record a run in which the messages of each topic on its way to nodes are disturbed."""
    ways = inputs_of(case.run)
    readers: Sequence[str] = list(ways) if reader == EACH else [reader]
    hops = [(each, topic) for each in readers for topic in ways[each]]
    last = case.steps - DISTURBED_STEPS
    begins = [(case.begin + number * DISTURBED_STEPS) % last for number in range(len(hops))]

    def arrange(graph: InProcessGraph) -> None:
        for each in readers:
            graph.add(each, cli_args=remaps(each, ways[each]))
        for (each, topic), begin in zip(hops, begins, strict=True):
            add_altering(graph, topic, Disturbance(how, begin), reader=each)

    return graph_run(case, folder, arrange)


def cases() -> Iterator[Case]:
    """Yield each disturbance of each way."""
    for how, where in DISTURBED.items():
        for reader, instant, mode, clutches in places(where):
            stated = SAME if mode == 'lockstep' else RUNS_ON
            if how == 'dropped' and mode == 'realtime':
                # What only the recorder lacks is not in the recording.
                stated = either(RUNS_ON, REFUSED)
            yield Case(
                *(f'message {how}', f'each topic to {reader}', instant, mode, clutches),
                stated,
                partial(disturb, how, reader),
            )
