# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A run with all nodes in this process, so that a fault can begin at an exact step."""

from collections.abc import Callable
from pathlib import Path

from support.in_process_graph import InProcessGraph
from support.patient_clock import PatientClock, realtime_owner

from ddct_plant.graph import sole_publishers
from faults.case import Case
from faults.outcome import Observed

PATIENCE_S = 10.0
"""Wall time in s that the driveline waits for an answer here; 60 s for users."""
WITHIN_S = 60.0
"""Wall time in s after which a run counts as hung."""
CHECK_S = 0.03
"""Period in s of the check for second publishers here; 0.2 s for users."""


def graph_run(
    case: Case,
    folder: Path,
    arrange: Callable[[InProcessGraph], object],
    patient_until: int | None = None,
) -> Observed:
    """
    Record the run of a case; `arrange(graph)` prepares its fault before it begins.

    In real time the clock waits for all replies until the fault begins, or until a given step, so
    that nothing but the fault disturbs the run before.
    """
    seen, run = Observed(fault_step=case.begin), case.run
    before, sole_publishers.CHECK_S = sole_publishers.CHECK_S, CHECK_S
    try:
        with InProcessGraph(run, folder) as graph:
            graph.parameters['driveline']['answer_timeout_s'] = PATIENCE_S
            arrange(graph)
            graph.add_all()
            if case.mode == 'realtime':
                until = case.begin if patient_until is None else patient_until
                PatientClock(realtime_owner(graph), until)
            seen.error = _spin(graph)
        seen.read(folder, run)
    finally:
        sole_publishers.CHECK_S = before
    return seen


def _spin(graph: InProcessGraph) -> str:
    """Spin until the run is over; return the error of the first node that failed, or ''."""
    try:
        graph.spin_to_end(WITHIN_S)
    except AssertionError:
        return f'the run hangs at step {graph.driveline.owner.step}'
    except Exception as error:  # what no node turns into an error of its own is a finding
        return f'traceback: {error!r}'
    errors = [f'{name}: {error}' for name, error in graph.failures().items()]
    try:
        graph.finish()
    except AssertionError:
        errors += [f'{name}: {error}' for name, error in graph.failures().items()]
    return errors[0] if errors else ''
