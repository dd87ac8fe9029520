# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Cost of a tuning beside the runs that it asks for."""

import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from bench.skeleton.comparison import Bench, Sides, comparison, extra

from ddct_bringup.tuning.conduct import carry_out_tuning
from ddct_bringup.tuning.evaluation import PlannedCase, TrialRuns
from ddct_bringup.tuning.specification.spec import tuning_spec_of
from ddct_bringup.tuning.tuning import tuning_of
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.registry import controller_spec

_SPEC = {
    'parameters': {
        'proportional_gain': {'low': 0.05, 'high': 0.5, 'scale': 'log'},
        'integral_gain': {'low': 0.01, 'high': 1.0, 'scale': 'log'},
    },
    'objectives': {'engagement_time_s': {}, 'peak_jerk_m_s3': {}},
    'constraints': {'engaged': {'at_least': 0.0}},
    'campaign': {
        'clutch': 'stick_slip',
        'random': {
            'samples': 5,
            'vary': {'wear_gain': {'distribution': 'uniform', 'low': 0.8, 'high': 1.2}},
        },
    },
    'trials': 32,
}


@comparison('tuning of pi, its trials', 'the runs alone', at_most=1.1)
def tuning(bench: Bench) -> Iterator[Sides]:
    """Processor time of 32 trials of 5 runs with sticking plates, search and record included."""
    extra('optuna')
    spec = tuning_spec_of(_SPEC, Path.cwd(), controller_spec('pi'))
    made = tuning_of('pi', spec, packaged_limits())

    def tuned() -> float:
        with tempfile.TemporaryDirectory() as folder:
            started = time.process_time()
            trials = carry_out_tuning(made, Path(folder) / 'out', workers=1)
            taken = time.process_time() - started
        asked[:] = [(each.values, row['index']) for each in trials for row in each.rows]
        return taken / len(asked)

    def alone() -> float:
        computed = TrialRuns(made, 1, lambda: False)
        started = time.process_time()
        computed.rows(asked)
        return (time.process_time() - started) / len(asked)

    asked: list[PlannedCase] = []
    yield Sides(tuned, alone)
