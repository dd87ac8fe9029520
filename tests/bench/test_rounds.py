# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rounds alternate, bounds count over the whole spread, and what is missing is no error."""

import gc
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from bench.skeleton.comparison import Bench, Comparison, NotMeasured, Sides, comparison, curve
from bench.skeleton.rounds import BAD, BETWEEN, FAILED, MET, MISSED, NOT_MEASURED, Result, measure
from bench.skeleton.workspace import Workspace

BENCH = Bench(Workspace(Path()))


def _measured(sides: Sides, rounds: int = 3, **options) -> list[Result]:
    @comparison('figure', 'reference', **options)
    def declared(bench: Bench) -> Iterator[Sides]:
        """Cost of a trial."""
        yield sides

    return measure(declared, BENCH, rounds)


@pytest.mark.parametrize(
    ('costs', 'outcome'),
    [
        ([1.0, 1.2, 1.5], MET),
        ([1.6, 1.4, 1.6], BETWEEN),
        ([1.6, 1.51, 9.0], MISSED),
    ],
)
def test_a_bound_is_missed_only_when_every_round_is_beyond_it(costs, outcome) -> None:
    left = iter(costs)
    sides = Sides(lambda: next(left), lambda: 1.0, warm_up=False)
    (result,) = _measured(sides, at_most=1.5)
    assert result.outcome == outcome
    assert result.ratios == tuple(costs)
    assert (outcome in BAD) == (outcome == MISSED)


def test_the_sides_alternate_and_so_does_the_order_within_a_round() -> None:
    calls: list[str] = []

    def side(name: str) -> Callable[[], float]:
        def cost() -> float:
            calls.append(name)
            return 1.0

        return cost

    _measured(Sides(side('ours'), side('reference')))
    warm_up = ['ours', 'reference']
    assert calls == [
        *warm_up, 'ours', 'reference', 'reference', 'ours', 'ours', 'reference',
    ]  # fmt: skip


def test_a_ratio_is_that_of_the_costs_of_one_round() -> None:
    """A machine that becomes ten times slower leaves the ratio as it is."""
    slowness = iter([1.0, 1.0, 10.0, 10.0, 10.0, 10.0])
    sides = Sides(lambda: 2.0 * next(slowness), lambda: next(slowness), warm_up=False)
    (result,) = _measured(sides)
    assert result.ratios == (2.0, 2.0, 2.0)


def test_each_quantity_has_its_own_ratio_and_bound() -> None:
    sides = Sides(lambda: {'median': 2.0, 'p99': 6.0}, lambda: {'median': 1.0, 'p99': 2.0})
    results = _measured(sides, at_most={'median': 1.5})
    assert [(each.name, each.median, each.outcome) for each in results] == [
        ('figure: median', 2.0, MISSED),
        ('figure: p99', 3.0, ''),
    ]


def test_a_bound_does_not_apply_beside_a_reference_that_excludes_it() -> None:
    (result,) = _measured(Sides(lambda: 9.0, lambda: 1.0, bounded=False), at_most=1.5)
    assert (result.bound, result.outcome) == (None, '')


def test_what_lacks_a_piece_is_not_measured_and_no_error() -> None:
    @comparison('page', 'a bare page', at_most=2.0)
    def declared(bench: Bench) -> Iterator[Sides]:
        """Time until it is drawn."""
        if bench is BENCH:
            raise NotMeasured('no browser')
        yield Sides(lambda: 1.0, lambda: 1.0)

    (result,) = measure(declared, BENCH, 3)
    assert (result.outcome, result.reason) == (NOT_MEASURED, 'no browser')
    assert result.outcome not in BAD


def test_an_error_of_a_side_is_a_failed_figure_with_its_reason() -> None:
    (result,) = _measured(Sides(lambda: 1.0, lambda: float('lost')))
    assert result.outcome == FAILED
    assert result.reason == "ValueError: could not convert string to float: 'lost'"
    assert result.outcome in BAD


def test_an_interruption_ends_the_bench_and_cleans_up() -> None:
    left: list[str] = ['a file']

    def interrupted() -> float:
        raise KeyboardInterrupt

    @comparison('figure', 'reference')
    def declared(bench: Bench) -> Iterator[Sides]:
        """Cost of a trial."""
        try:
            yield Sides(interrupted, lambda: 1.0)
        finally:
            left.clear()

    with pytest.raises(KeyboardInterrupt):
        measure(declared, BENCH, 3)
    assert not left


def test_a_side_does_not_pay_for_collecting_the_objects_of_the_bench() -> None:
    """They are frozen while it is measured, and not afterwards."""
    frozen: list[int] = []

    def side() -> float:
        frozen.append(gc.get_freeze_count())
        return 1.0

    _measured(Sides(side, side), rounds=1)
    assert min(frozen) > 1000
    assert gc.get_freeze_count() == 0


def test_a_curve_has_a_comparison_for_each_value() -> None:
    @curve('chain', 'a short chain', 'nodes', (2, 4))
    def declared(bench: Bench, nodes: int) -> Iterator[Sides]:
        """Time per step."""
        yield Sides(lambda: nodes, lambda: 2)

    def ratio(point: Comparison) -> float:
        (result,) = measure(point, BENCH, 1)
        return result.median

    assert [each.name for each in declared] == ['chain, nodes 2', 'chain, nodes 4']
    assert [ratio(each) for each in declared] == [1.0, 2.0]
