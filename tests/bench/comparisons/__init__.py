# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""All comparisons of `make bench`, in the order of its table; one module for each subject."""

from bench.comparisons import (
    base,
    batch,
    campaign,
    exported_c,
    graph,
    headless,
    least_jerk_step,
    mpc_step,
    qp,
    report_page,
    shift,
    start_up,
    suite,
    synthesis,
    tuning,
    verdict,
)
from bench.skeleton.comparison import comparisons_in

ALL = [
    each
    for module in (
        graph,
        start_up,
        headless,
        shift,
        batch,
        qp,
        mpc_step,
        least_jerk_step,
        exported_c,
        synthesis,
        verdict,
        campaign,
        tuning,
        report_page,
        base,
        suite,
    )
    for each in comparisons_in(module)
]
