# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Ratios of two costs that are measured in turn, so that a slow machine slows both."""

import gc
import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass

Cost = Callable[[], float]
"""Function that measures once and returns a cost in any unit, such as seconds per step."""


class NotMeasured(Exception):  # noqa: N818, it is an outcome and no error
    """A peer is not installed; the text is the reason."""


@dataclass(frozen=True)
class Comparison:
    """What is measured beside which reference."""

    name: str
    reference: str
    prepare: Callable[[], tuple[Cost, Cost]]
    """Function that returns our cost and that of the reference; NotMeasured without the peer."""


@dataclass(frozen=True)
class Result:
    """Our cost over that of the reference in each round, or the reason why there is none."""

    name: str
    reference: str
    ratios: Sequence[float] = ()
    reason: str = ''

    def line(self) -> str:
        """Return the line of the table: median, least and most of the rounds."""
        if self.reason:
            return f'{self.name:44} {self.reference}: {self.reason}'
        median, least, most = statistics.median(self.ratios), min(self.ratios), max(self.ratios)
        return f'{self.name:44} {median:7.3g} {least:7.3g} {most:7.3g}  {self.reference}'


HEAD = f'{"ours over the reference":44} {"median":>7} {"least":>7} {"most":>7}  reference'


def measure(comparison: Comparison, rounds: int) -> Result:
    """Return the ratios of some rounds after one that does not count."""
    try:
        sides = comparison.prepare()
    except NotMeasured as reason:
        return Result(comparison.name, comparison.reference, reason=str(reason))
    ratios = []
    gc.collect()
    gc.freeze()  # a collection of all that is imported takes as long as many runs
    for number in range(rounds + 1):
        # The order alternates: a machine that slows down within a round favours neither.
        order = (0, 1) if number % 2 else (1, 0)
        costs = {side: sides[side]() for side in order}
        ratios.append(costs[0] / costs[1])
    gc.unfreeze()
    return Result(comparison.name, comparison.reference, ratios[1:])
