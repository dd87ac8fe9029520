"""
The Pareto view: two criteria against each other, and the runs that no other run beats in both.

Less of a criterion's magnitude is better, as its limit is a highest magnitude. Only engaged runs
compete: one that stalls at once has a small friction energy, and is no better for that.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement

from ddct_bringup.report.page_parts import unit_text, value_text
from ddct_bringup.report.runs import ReportRun
from ddct_bringup.verdict.criteria import CRITERIA, Criterion
from ddct_bringup.verdict.state import ENGAGED

DEFAULT_PAIR = ('friction_energy', 'peak_jerk')
"""Across and up: what the facing pays, and what the passenger feels. Every whole run has both."""
_MARGIN = 0.06
_TICKS = 5


@dataclass(frozen=True)
class ParetoCriterion:
    """One criterion as an axis; runs by their position in the report."""

    title: str
    """With the unit."""
    values: Mapping[int, str]
    """As printed; of the runs that have a value."""
    places: Mapping[int, float]
    """Along the axis, 0 to 1."""
    ticks: Sequence[tuple[str, float]]
    """Text and place."""


@dataclass(frozen=True)
class ParetoView:
    """Everything that the view can show."""

    criteria: Mapping[str, ParetoCriterion]
    """By name; those of which two runs or more have a value."""
    fronts: Mapping[str, Sequence[int]]
    """The runs that no other beats, by `pair_key`; a criterion goes with itself too."""
    default: tuple[str, str]
    """Names of the criteria shown first, across and up."""


def pair_key(first: str, second: str) -> str:
    """Return what a front is found by, whichever criterion comes first."""
    return ' '.join(sorted((first, second)))


def pareto_view(runs: Sequence[ReportRun]) -> ParetoView | None:
    """Return the view over the runs, None where no two criteria have values of two runs."""
    magnitudes = _magnitudes(runs)
    if len(magnitudes) < 2:
        return None
    engaged = [index for index, run in enumerate(runs) if run.entry['verdict']['state'] == ENGAGED]
    fronts = {
        pair_key(first, second): non_dominated(
            {
                run: (magnitudes[first][run], magnitudes[second][run])
                for run in engaged
                if run in magnitudes[first] and run in magnitudes[second]
            }
        )
        for first, second in combinations_with_replacement(magnitudes, 2)
    }
    first, second = [*magnitudes][:2]
    return ParetoView(
        criteria={
            each.key: _axis(each, magnitudes[each.key])
            for each in CRITERIA
            if each.key in magnitudes
        },
        fronts=fronts,
        default=DEFAULT_PAIR if set(DEFAULT_PAIR) <= set(magnitudes) else (first, second),
    )


def non_dominated(points: Mapping[int, tuple[float, float]]) -> list[int]:
    """
    Return the runs than which no other is better in one coordinate and as good in the other.

    Less is better. Runs of equal points stay together.
    """
    return [
        run
        for run, (x, y) in points.items()
        if not any(
            other != (x, y) and other[0] <= x and other[1] <= y for other in points.values()
        )
    ]


def _magnitudes(runs: Sequence[ReportRun]) -> dict[str, dict[int, float]]:
    """Return by criterion the magnitudes of the valid runs, where two or more have one."""
    found: dict[str, dict[int, float]] = {criterion.key: {} for criterion in CRITERIA}
    for index, run in enumerate(runs):
        if not run.entry['valid']:
            continue
        for each in run.entry['verdict']['criteria']:
            if each['value'] is not None:
                found[each['name']][index] = abs(each['value'])
    return {name: values for name, values in found.items() if len(values) >= 2}


def _axis(criterion: Criterion, values: Mapping[int, float]) -> ParetoCriterion:
    unit = unit_text(criterion.unit)
    lowest, highest = min(values.values()), max(values.values())
    span = (highest - lowest) or abs(highest) or 1.0
    first, last = lowest - _MARGIN * span, highest + _MARGIN * span
    return ParetoCriterion(
        title=f'{criterion.symbol}, {unit}' if unit else criterion.symbol,
        values={run: f'{value_text(value)} {unit}'.strip() for run, value in values.items()},
        places={run: round((value - first) / (last - first), 4) for run, value in values.items()},
        ticks=[
            (f'{tick:g}', round((tick - first) / (last - first), 4))
            for tick in _round_numbers(first, last)
        ],
    )


def _round_numbers(first: float, last: float) -> list[float]:
    """Return the multiples of 1, 2 or 5 times a power of ten between two numbers, some five."""
    raw = (last - first) / _TICKS
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(factor * power for factor in (1, 2, 5, 10) if factor * power >= raw)
    numbers = range(math.ceil(first / step), math.floor(last / step) + 1)
    return [float(f'{number * step:.12g}') for number in numbers]
