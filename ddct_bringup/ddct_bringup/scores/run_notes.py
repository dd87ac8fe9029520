# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Notes below a table of runs: why a run did not engage, limitations of its figures."""

from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.state import NOT_ENGAGED
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.signals.gain_changes import changes_note

_GROWN_RPM = 3000.0
"""Slip at the end in rpm with which no engagement begins: the controller has raised it."""


def run_notes(run: ScoredRun) -> list[str]:
    """Return notes on one run: why it did not engage, or on its figures."""
    notes = [f'{run.state}: {run.why}'] if run.why else []
    if run.state == NOT_ENGAGED and abs(run.metrics.get('slip_final_rpm') or 0.0) > _GROWN_RPM:
        notes.append('the slip has grown: ddct check CONTROLLER finds a wrong sign or unit')
    if run.valid and run.fallbacks:
        notes.append(fallback_note(run))
    if run.gain_changes:
        notes.append(changes_note(run.gain_changes))
    notes += slow_notes(run)
    return notes


def slow_notes(run: ScoredRun) -> list[str]:
    """
    Return a note if too many updates are longer than the period.

    Of a real-time run that are over 1 %, of another one, which waits for them, over half.
    """
    median, most = (in_ms(run.metrics.get(f'update_time_{name}_us')) for name in ('median', 'p99'))
    if run.facts is None or median is None or most is None:
        return []
    if (most if run.facts.mode == 'realtime' else median) <= 1e3 * PERIOD_S:
        return []
    return [
        f'too slow for real time: its updates take {median:.1f} ms in the median, 1 % of them '
        f'more than {most:.1f} ms; the period is {1e3 * PERIOD_S:g} ms'
    ]


def fallback_note(run: ScoredRun) -> str:
    """Return a note on a run whose controller had steps without a solution of its program."""
    return (
        f'at {run.fallbacks} of {run.metrics["steps"]} steps its program had no solution in '
        'time: the figures are partly those of its fallback'
    )


def in_ms(time_us: float | None) -> float | None:
    """Return a time in us as ms, None for None."""
    return None if time_us is None else time_us / 1e3
