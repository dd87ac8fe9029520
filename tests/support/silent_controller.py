# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Real-time run whose controller stops publishing on the way."""

import signal
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from support.in_process_graph import InProcessGraph
from support.processes import START_S, Programs

_APART_STEPS = 20


def run_until_silent(
    graph: InProcessGraph,
    programs: Programs,
    listener: Any,
    has_come_to: Callable[[int], bool],
    signals: Sequence[signal.Signals],
    first_step: int,
) -> float:
    """
    Run with the controller in a process of its own, which gets the signals at a step.

    `has_come_to(step)` returns whether the listener, a node, has received that step or a later
    one. Return the time, s, that the controller had waited for a processor from step 0 to then.
    """
    shared = graph.parameters['*'] | graph.parameters['controller']
    controller = programs.start_node('ddct_controllers.controller_node', shared)
    graph.add_other(listener)
    graph.add_all(without=['controller'])
    graph.spin_until(partial(has_come_to, 0), 'step 0', START_S)
    started_s, waited_s = _waited_s(controller.process.pid), 0.0
    for number, sent in enumerate(signals):
        step = first_step + _APART_STEPS * number
        graph.spin_until(partial(has_come_to, step), f'step {step}', START_S)
        waited_s = waited_s or _waited_s(controller.process.pid) - started_s
        controller.send(sent)
    graph.run()
    controller.send(signal.SIGKILL)
    return waited_s


def _waited_s(pid: int) -> float:
    """Return the time, s, that the threads of a process were ready and did not run (Linux)."""
    files = Path(f'/proc/{pid}/task').glob('*/schedstat')
    return 1e-9 * sum(int(file.read_text().split()[1]) for file in files)
