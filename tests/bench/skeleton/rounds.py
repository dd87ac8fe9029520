# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Measure comparisons in rounds in which both sides alternate, and judge their ratios."""

import gc
import statistics
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from bench.skeleton.comparison import Bench, Comparison, NotMeasured, Point, Sides, as_costs

MET, BETWEEN, MISSED, NO_BOUND = 'met', 'between', 'MISSED', ''
NOT_MEASURED, FAILED = 'not measured', 'FAILED'
BAD = (MISSED, FAILED)
"""Outcomes that make the exit code 1."""


@dataclass(frozen=True)
class Result:
    """Ratios of one quantity in all rounds, or the reason why there are none."""

    name: str
    reference: str
    ratios: tuple[float, ...] = ()
    bound: float | None = None
    point: Point | None = None
    reason: str = ''
    """Reason why it was not measured or failed."""
    failed: bool = False

    @property
    def median(self) -> float:
        """Median of the ratios of the rounds."""
        return statistics.median(self.ratios)

    @property
    def outcome(self) -> str:
        """
        Outcome of the bound over the whole spread of the rounds.

        A bound is met when no round is beyond it, missed when every round is, and else between.
        """
        if self.reason:
            return FAILED if self.failed else NOT_MEASURED
        if self.bound is None:
            return NO_BOUND
        if min(self.ratios) > self.bound:
            return MISSED
        return MET if max(self.ratios) <= self.bound else BETWEEN


def measure(
    comparison: Comparison,
    bench: Bench,
    rounds: int,
    progress: Callable[[int], None] = lambda done: None,
) -> list[Result]:
    """
    Return a result for each quantity; `progress` gets the number of rounds done.

    An error in a side is a failed result with its reason, so that all other figures are kept.
    """
    try:
        with comparison.sides(bench) as sides, _own_objects_only():
            return _results(comparison, sides, rounds, progress)
    except NotMeasured as reason:
        return [_without_ratios(comparison, str(reason), failed=False)]
    except Exception as error:
        return [_without_ratios(comparison, f'{type(error).__name__}: {error}', failed=True)]


@contextmanager
def _own_objects_only() -> Iterator[None]:
    """
    Keep the objects that exist now out of garbage collection.

    A collection of all that the bench has imported takes as long as many runs, and a product has
    far fewer objects.
    """
    gc.collect()
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()


def _results(
    comparison: Comparison, sides: Sides, rounds: int, progress: Callable[[int], None]
) -> list[Result]:
    if sides.warm_up:
        sides.ours(), sides.reference()
    measured = []
    for done in range(rounds):
        progress(done)
        # The order alternates too: a machine that slows down within a round favours neither.
        if done % 2:
            theirs = as_costs(sides.reference())
            ours = as_costs(sides.ours())
        else:
            ours = as_costs(sides.ours())
            theirs = as_costs(sides.reference())
        measured.append(sides.ratios(ours, theirs))
    return [
        Result(
            f'{comparison.name}: {quantity}' if quantity else comparison.name,
            comparison.reference,
            tuple(ratios[quantity] for ratios in measured),
            comparison.bound_of(quantity) if sides.bounded else None,
            comparison.point,
        )
        for quantity in measured[0]
    ]


def _without_ratios(comparison: Comparison, reason: str, *, failed: bool) -> Result:
    return Result(
        comparison.name, comparison.reference, point=comparison.point, reason=reason, failed=failed
    )
