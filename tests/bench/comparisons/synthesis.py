# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time of the H-infinity synthesis for the printed weights, beside SLICOT's."""

import time
from collections.abc import Callable, Iterator

from bench.peers.slicot import slycot_optimum
from bench.skeleton.comparison import Bench, Sides, comparison, extra

from ddct_controllers.design.h_infinity.design import generalised_plant
from ddct_controllers.design.h_infinity.recipes import make_weights
from ddct_controllers.design.h_infinity.synthesis.gamma_iteration import synthesise

_TOLERANCE = 1e-3
"""Largest excess of our level over that of SLICOT, relative."""


@comparison('H-infinity synthesis', 'SLICOT through slycot')
def h_infinity(bench: Bench) -> Iterator[Sides]:
    """Processor time; both bisect on the level and verify each controller by its loop's norm."""
    slycot = extra('slycot')
    plant = generalised_plant(make_weights('thesis'))
    ours, theirs = synthesise(plant, 1.0).gamma, slycot_optimum(slycot, plant)
    if ours > (1.0 + _TOLERANCE) * theirs:
        raise ValueError(f'our level is {ours:.5f}, that of SLICOT {theirs:.5f}')
    yield Sides(
        lambda: seconds(lambda: synthesise(plant, 1.0)),
        lambda: seconds(lambda: slycot_optimum(slycot, plant)),
    )


def seconds(task: Callable[[], object]) -> float:
    """Return the processor time of a task in s."""
    started = time.process_time()
    task()
    return time.process_time() - started
