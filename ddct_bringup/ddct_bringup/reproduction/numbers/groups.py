"""Groups of the gate's file: what one computation yields is shown whole and counted once."""

from collections import defaultdict
from collections.abc import Iterable, Sequence

from ddct_bringup.reproduction.numbers.thesis_number import (
    ERRATUM,
    REPRODUCED,
    ThesisNumber,
    Tolerance,
)
from ddct_plant.base.errors import ParameterError

_OF_THE_PRINT = 'reproduced or erratum'


def by_fact(numbers: Iterable[ThesisNumber]) -> dict[str, list[ThesisNumber]]:
    """Return the numbers of each group, a number without one under its own name."""
    found: dict[str, list[ThesisNumber]] = defaultdict(list)
    for number in numbers:
        found[number.fact].append(number)
    return dict(found)


def require_one_rule(numbers: Iterable[ThesisNumber]) -> None:
    """
    Raise ParameterError for a group that does not treat its numbers alike.

    All numbers of a group come from one kind of source, so that none can stand without a computed
    value beside others that have one, and those of one unit have one tolerance.
    """
    for name, members in by_fact(numbers).items():
        kinds = sorted({_kind(number) for number in members})
        if len(kinds) > 1:
            raise ParameterError(f'group {name!r}: verdicts of different kinds: {kinds}')
        tolerances: dict[str, set[Tolerance]] = defaultdict(set)
        for number in members:
            if number.tolerance:
                tolerances[number.unit].add(number.tolerance)
        mixed = [unit for unit, found in tolerances.items() if len(found) > 1]
        if mixed:
            raise ParameterError(f'group {name!r}: more than one tolerance in {mixed[0]}')


def _kind(number: ThesisNumber) -> str:
    return _OF_THE_PRINT if number.verdict in (REPRODUCED, ERRATUM) else number.verdict


def fact_outcome(outcomes: Sequence[str]) -> str:
    """Return what a group comes to: the worst of its numbers, so that no miss hides in it."""
    return next(
        (found for found in outcomes if found == ERRATUM or found.endswith('miss')), outcomes[0]
    )
