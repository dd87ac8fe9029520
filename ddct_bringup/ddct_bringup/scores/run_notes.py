# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Notes below a table of runs: invalid runs, limits that are exceeded, floors."""

from collections.abc import Sequence

from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.state import SUCCESSES
from ddct_bringup.verdict.verdict import BEYOND, NO_LIMIT, UNAVOIDABLE
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.signals.gain_changes import changes_note


def run_notes(run: ScoredRun) -> list[str]:
    """Return notes on one run: why it is invalid, or on limitations of its scores."""
    notes = [] if run.valid else [f'not valid: {run.reason}']
    if run.valid and run.fallbacks:
        notes.append(fallback_note(run))
    if run.gain_changes:
        notes.append(changes_note(run.gain_changes))
    notes += [*slow_notes(run), *unknown_limits_notes(run)]
    names_by_reason: dict[str, list[str]] = {}
    for name, why in run.not_computed.items():
        names_by_reason.setdefault(why, []).append(name)
    notes += [f'{why}: no {", ".join(names)}' for why, names in names_by_reason.items()]
    if run.before_schema:
        notes.append('recorded before scenarios had a schema_version: judged by what it holds')
    return notes


def beyond_notes(runs: Sequence[ScoredRun]) -> list[str]:
    """
    Return for each exceeded limit its source, and the runs that exceed it with their values.

    Beside a value is the least that a run with the same lock time can have, where it is known.
    """
    beyond: dict[str, list[str]] = {}
    for run in runs:
        for each in run.verdict.results:
            if each.state == BEYOND:
                limit = f'beyond {each.name} {each.limit:g} {each.unit}'
                found = beyond.setdefault(f'{limit} ({each.source})', [])
                least = '' if not each.least else f' (at its lock time at least {each.least:.3g})'
                found.append(f'{run.bag} {each.value:.4g}{least}')
    return [f'{limit}: {", ".join(found)}' for limit, found in beyond.items()]


def unavoidable_notes(runs: Sequence[ScoredRun]) -> list[str]:
    """Return for each limit that no controller can keep its source, and the runs' values."""
    found: dict[str, list[str]] = {}
    for run in runs:
        for each in run.verdict.results:
            if each.state == UNAVOIDABLE:
                limit = (
                    f'unavoidable {each.name} {each.limit:g} {each.unit} ({each.source}): no '
                    f'controller of the clutch can have less than {each.least_at_any_lock:.4g}'
                )
                found.setdefault(limit, []).append(f'{run.bag} {each.value:.4g}')
    return [f'{limit}: {", ".join(values)}' for limit, values in found.items()]


def no_floor_notes(runs: Sequence[ScoredRun]) -> list[str]:
    """Return each reason why runs have no floors, with these runs."""
    found: dict[str, list[str]] = {}
    for run in runs:
        if run.no_floor:
            found.setdefault(run.no_floor, []).append(run.bag)
    return [f'no floor, as {reason}: {", ".join(names)}' for reason, names in found.items()]


def unknown_limits_notes(run: ScoredRun) -> list[str]:
    """Return the limits of a successful run that cannot be checked because a value is missing."""
    verdict = run.verdict
    unknown = [
        each.name for each in verdict.criteria if each.limit is not None and each.value is None
    ]
    if not unknown or verdict.state not in SUCCESSES or verdict.limits != NO_LIMIT:
        return []
    return [f'not known to keep within its limits: no value of {", ".join(unknown)}']


def slow_notes(run: ScoredRun) -> list[str]:
    """Return a note if more than 1 % of a controller's updates are longer than the period."""
    median, most = (in_ms(run.metrics[f'update_time_{name}_us']) for name in ('median', 'p99'))
    if median is None or most is None or most <= 1e3 * PERIOD_S:
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
