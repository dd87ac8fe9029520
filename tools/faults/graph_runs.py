# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A run with all nodes in this process, so that a fault can begin at an exact step."""

from collections.abc import Callable
from pathlib import Path

from support.in_process_graph import InProcessGraph

from faults.case import Case
from faults.outcome import Observed


def graph_run(
    case: Case,
    folder: Path,
    arrange: Callable[[InProcessGraph], object] = lambda _: None,
    act: Callable[[InProcessGraph], object] | None = None,
) -> Observed:
    """
    Record the run of a case; `arrange(graph)` prepares its fault, `act(graph)` begins it.

    It is in virtual time, so that nothing but the fault disturbs it.
    """
    seen, run = Observed(fault_step=case.begin), case.run
    with InProcessGraph(run, folder) as graph:
        arrange(graph)
        graph.add_all()
        if act is not None:
            owner = graph.driveline.owner
            graph.spin_until(lambda: owner.step >= case.begin and bool(owner.missing()), 'a tick')
            act(graph)
        seen.error = _spin(graph)
    seen.read(folder, run)
    return seen


def _spin(graph: InProcessGraph) -> str:
    """Spin until the run is over; return the error of the first node that failed, or ''."""
    try:
        graph.spin_to_end()
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
