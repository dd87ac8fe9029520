# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Comparisons: what is measured, against which reference, and the bound of their ratio.

    @comparison('graph: separate processes', 'the bare chain', at_most=1.5)
    def separate_processes(bench: Bench) -> Iterator[Sides]:
        yield Sides(lambda: graph_s('pi'), lambda: chain_s())

The function prepares both sides, yields them once, and cleans up after the `yield`. A side returns
its cost in any unit, such as seconds per step, or several costs by the name of a quantity. The
ratio of a round is our cost over that of the reference, so less is better.
"""

import importlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

from bench.skeleton.workspace import Workspace

Cost = float | Mapping[str, float]
"""Cost of one measurement, above 0, or costs by the name of a quantity."""
ONE = ''
"""Name of the quantity of a comparison that has only one."""


class NotMeasured(Exception):  # noqa: N818, it is an outcome and no error
    """A piece that a comparison needs is missing on this machine; the text is the reason."""


@dataclass(frozen=True)
class Bench:
    """What comparisons measure: this workspace, and the one of the base commit."""

    ours: Workspace
    base: Workspace | None = None

    def require_base(self) -> Workspace:
        """Return the workspace of the base commit; raise NotMeasured without one."""
        if self.base is None:
            raise NotMeasured('no base commit: make bench BASE=REV')
        return self.base


def as_costs(cost: Cost) -> Mapping[str, float]:
    """Return the costs by quantity."""
    return cost if isinstance(cost, Mapping) else {ONE: cost}


def ratios_of(ours: Mapping[str, float], reference: Mapping[str, float]) -> Mapping[str, float]:
    """Return the ratio of each quantity; a reference with one cost serves all quantities."""
    return {name: cost / reference.get(name, reference.get(ONE, 0)) for name, cost in ours.items()}


@dataclass(frozen=True)
class Sides:
    """The two sides of a comparison; each function measures once and returns its cost."""

    ours: Callable[[], Cost]
    reference: Callable[[], Cost]
    bounded: bool = True
    """Whether the bounds of the comparison apply to this reference."""
    warm_up: bool = True
    """Whether each side is called once, unmeasured, before the first round."""
    ratios: Callable[[Mapping[str, float], Mapping[str, float]], Mapping[str, float]] = ratios_of
    """Function from the costs of one round to its ratios by quantity."""


@dataclass(frozen=True)
class Point:
    """Point of a curve: the name of the abscissa, such as `nodes`, and its value."""

    abscissa: str
    value: float


@dataclass(frozen=True)
class Comparison:
    """One comparison; `sides` yields its two sides for a bench."""

    name: str
    reference: str
    meaning: str
    """What a cost is: the docstring of the function that prepares the sides."""
    sides: Callable[[Bench], AbstractContextManager[Sides]]
    bounds: Mapping[str, float] = field(default_factory=dict)
    """Largest ratio by quantity; the bound of `ONE` applies to quantities without their own."""
    point: Point | None = None
    only_by_name: bool = False
    """Whether it is measured only where its name is given."""

    def bound_of(self, quantity: str) -> float | None:
        """Return the largest ratio of a quantity, None where it has no bound."""
        return self.bounds.get(quantity, self.bounds.get(ONE))


Prepare = Callable[[Bench], Iterator[Sides]]


def comparison(
    name: str,
    reference: str,
    *,
    at_most: float | Mapping[str, float] | None = None,
    only_by_name: bool = False,
) -> Callable[[Prepare], Comparison]:
    """Return a decorator that makes a comparison; `at_most` is its bound, or one by quantity."""
    bounds = {} if at_most is None else as_costs(at_most)

    def declare(prepare: Prepare) -> Comparison:
        sides = contextmanager(prepare)
        return Comparison(
            name, reference, _meaning(prepare), sides, bounds, only_by_name=only_by_name
        )

    return declare


def curve(
    name: str, reference: str, abscissa: str, values: Sequence[float]
) -> Callable[[Callable[[Bench, Any], Iterator[Sides]]], tuple[Comparison, ...]]:
    """Return a decorator that makes a comparison for each value of an abscissa."""

    def declare(prepare: Callable[[Bench, Any], Iterator[Sides]]) -> tuple[Comparison, ...]:
        def sides_at(value: float) -> Callable[[Bench], AbstractContextManager[Sides]]:
            return contextmanager(lambda bench: prepare(bench, value))

        return tuple(
            Comparison(
                f'{name}, {abscissa} {value:g}',
                reference,
                _meaning(prepare),
                sides_at(value),
                point=Point(abscissa, value),
            )
            for value in values
        )

    return declare


def comparisons_in(module: ModuleType) -> list[Comparison]:
    """Return the comparisons and the points of curves of a module, in the order of its text."""
    found: list[Comparison] = []
    for value in vars(module).values():
        for one in value if isinstance(value, tuple) else (value,):
            if isinstance(one, Comparison):
                found.append(one)
    return found


def extra(package: str) -> Any:
    """Return an optional package; raise NotMeasured where it is not installed."""
    try:
        return importlib.import_module(package)
    except ImportError as error:
        raise NotMeasured(f'{package} is not installed ({error})') from error


def _meaning(prepare: Callable[..., Any]) -> str:
    return (prepare.__doc__ or '').strip().partition('\n')[0]
