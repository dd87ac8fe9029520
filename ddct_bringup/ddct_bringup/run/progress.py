"""Run a plan with signs of life on standard error."""

import sys
import time
from pathlib import Path

from rich.console import Console

from ddct_bringup.processes.live_process import LiveView
from ddct_bringup.run.execution import execute
from ddct_bringup.run.plan import RunPlan
from ddct_plant.program.stop_signals import stop_signals


def run_with_progress(
    plan: RunPlan, folder: Path, label: str = '', live: LiveView | None = None
) -> None:
    """
    Carry out `plan` into `folder`, saying what runs and how fast it went.

    Raise DdctError when the run does not end well, KeyboardInterrupt after SIGINT or SIGTERM.
    """
    scenario = plan.settings.scenario
    what = f'{label}{plan.name}: {scenario.duration_s:g} s of {scenario.name}'
    started = time.monotonic()
    with stop_signals() as stops, Console(file=sys.stderr).status(f'{what}, {plan.layout}'):
        execute(plan, folder, lambda: bool(stops), live)
    if stops:
        # It came when the run had ended already: whatever would follow is not wanted.
        raise KeyboardInterrupt
    elapsed = time.monotonic() - started
    print(f'{what} in {elapsed:.1f} s ({plan.layout})', file=sys.stderr, flush=True)
