# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time of one step of exported C controllers, beside the Python controllers they come from."""

import tempfile
from collections.abc import Iterator
from pathlib import Path

from bench.peers.exported_c import CASES, ExportedController
from bench.peers.qp_solvers import percentiles
from bench.peers.replay import times_of
from bench.skeleton.comparison import Bench, Comparison, Sides, comparison


def _exported(case: str) -> Comparison:
    @comparison(f'{case} as C, update', 'the same controller in Python')
    def sides(bench: Bench) -> Iterator[Sides]:
        """Wall time of an update with the measurements of one closed-loop run."""
        with tempfile.TemporaryDirectory() as folder:
            exported = ExportedController(case, Path(folder))
            yield Sides(
                lambda: percentiles((1e-6 * exported.run()[1][:, 0]).tolist()),
                lambda: percentiles(times_of(exported.original, exported.measurements)),
            )

    return sides


EXPORTED = tuple(_exported(case) for case in CASES)
