# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Programs of this version beside those of the base commit; both run as a user runs them."""

import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from bench.comparisons.campaign import run_s
from bench.comparisons.graph import SINGLE, graph_s, timing_of
from bench.comparisons.start_up import BASE
from bench.skeleton.comparison import Bench, Comparison, Sides, comparison
from bench.skeleton.workspace import Workspace


def _beside_the_base(name: str, cost: Callable[[Workspace], float]) -> Comparison:
    @comparison(name, BASE)
    def sides(bench: Bench) -> Iterator[Sides]:
        """Cost of the same program of both versions."""
        base = bench.require_base()
        yield Sides(lambda: cost(bench.ours), lambda: cost(base), warm_up=False)

    return sides


def _headless_s(workspace: Workspace, *options: str) -> float:
    timing = timing_of(workspace, '--headless', '--set', 'duration_s=20', *options)
    return timing['wall_time_s'] / timing['steps']


def _compare_s(workspace: Workspace) -> float:
    """Return the wall time in s of `compare` with the controllers of the demo."""
    with tempfile.TemporaryDirectory() as folder:
        controllers = 'pi,ls8,hinf1,mpc3,mpc4'
        out = Path(folder) / 'runs'
        return workspace.run('ddct', 'compare', '--controllers', controllers, '--out', out).wall_s


BESIDE_THE_BASE = (
    _beside_the_base('graph: one process per node, step', graph_s),
    _beside_the_base('graph: one process, step', lambda place: graph_s(place, SINGLE)),
    _beside_the_base('compare of the demo, wall time', _compare_s),
    _beside_the_base('headless step of PI', _headless_s),
    _beside_the_base(
        'headless step of PI with sticking plates',
        lambda place: _headless_s(place, '--clutch', 'stick_slip'),
    ),
    _beside_the_base(
        'headless step of mpc3', lambda place: _headless_s(place, '--controller', 'mpc3')
    ),
    _beside_the_base(
        'campaign of linear runs, run', lambda place: run_s(place, 'pi', 'linear', 2000)
    ),
    _beside_the_base(
        'campaign of mpc3 with sticking plates, run',
        lambda place: run_s(place, 'mpc3', 'stick_slip', 50),
    ),
)
