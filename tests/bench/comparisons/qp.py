# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time of quadratic programs of slip control with our default backend, beside other solvers."""

from collections.abc import Iterator
from itertools import product

from bench.peers.qp_programs import SlipControl
from bench.peers.qp_solvers import REFERENCES, backend, distance, solve_times
from bench.skeleton.comparison import Bench, Comparison, Sides, comparison

from ddct_controllers.mpc.qp.backend import DEFAULT_BACKEND

SIZES = {
    '4 moves, 8 hard rows': (4, 22, False),
    '4 moves, 8 hard and 22 soft rows': (4, 22, True),
    '50 moves, 100 hard and 50 soft rows': (50, 50, True),
}
"""Number of moves, number of predicted outputs, and whether these have soft rows, by label."""
_TOLERANCE = 1e-3
"""Largest distance of solutions whose times are compared, relative."""
_COMPARED = slice(0, None, 10)


def _programs(label: str, reference: str) -> Comparison:
    @comparison(f'QP of {label}', reference)
    def sides(bench: Bench) -> Iterator[Sides]:
        """Wall time of one solve of a run, warm-started; equal solutions are required."""
        control = SlipControl(*SIZES[label])
        steps, structure = control.steps(), control.structure
        ours, theirs = backend(DEFAULT_BACKEND)(structure), REFERENCES[reference](structure)
        apart = distance(structure, theirs, ours, steps[_COMPARED])
        if apart > _TOLERANCE:
            raise ValueError(f'the solutions of {reference} differ from ours by {apart:.1e}')
        yield Sides(lambda: solve_times(ours, steps), lambda: solve_times(theirs, steps))

    return sides


PROGRAMS = tuple(_programs(label, reference) for reference, label in product(REFERENCES, SIZES))
