# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time per step of a gear shift without a graph: two clutches beside one."""

from collections.abc import Iterator
from functools import partial

from bench.comparisons.headless import step_s
from bench.skeleton.comparison import Bench, Sides, comparison

from ddct_plant.models.clutch import STICK_SLIP


@comparison('headless step of a shift', 'a launch', at_most=1.6)
def shift_beside_launch(bench: Bench) -> Iterator[Sides]:
    """Processor time per step under PI: two clutches and a handover beside one clutch."""
    shift, launch = (partial(step_s, 'pi', name, STICK_SLIP) for name in ('upshift', 'launch'))
    yield Sides(shift, launch)
