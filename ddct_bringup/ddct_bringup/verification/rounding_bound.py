# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Bound of a run that amplifies rounding: measured by the same run with other last bits.

Other kernels round differently in the last bits. Some loops, and the design of some controllers,
amplify that beyond `BOUND`. An engine inertia whose last bits are others changes every rounding
of the run too, so that the differences which this makes are as large as those of other kernels.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from ddct_bringup.campaign.columns import COMPARED
from ddct_bringup.campaign.rows import Row
from ddct_bringup.campaign.run_set import ImpossibleRow, PlannedRow
from ddct_bringup.campaign.scored import Scorer
from ddct_bringup.run.execution import simulate
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.verdict.limits import Limits
from ddct_bringup.verification.comparison import BOUND, Comparison, plain_json
from ddct_plant.base.errors import FOREIGN_FAILURES
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.signals.gain_changes import GainChange

LARGEST = 1e-3
"""Largest bound: what rounding changes by more than that cannot be compared."""
_CHANGES = tuple(number * 2.0**-50 for number in (-4, -3, -2, -1, 1, 2, 3, 4))
"""Relative changes of the engine inertia: smaller ones would often give equal bits."""
_MARGIN = 10.0
"""Ratio of the bound to the largest difference that these changes make."""


def bound_of_row(run: PlannedRow | ImpossibleRow, limits: Limits) -> float:
    """Return the bound of a row of a campaign."""
    if isinstance(run, ImpossibleRow):
        return BOUND
    scorer = Scorer(limits, at_once=False)

    def row_of(settings: RunSettings) -> Row:
        (found,) = scorer.scored([replace(run, settings=settings)])
        return found.row()

    ours = row_of(run.settings)

    def compare(settings: RunSettings) -> Comparison:
        comparison, theirs = Comparison(), row_of(settings)
        for name in COMPARED:
            comparison.add({}, plain_json(ours[name]), plain_json(theirs[name]))
        return comparison

    return _bound(run.settings, compare)


def bound_of_run(plan: RunPlan, changes: Sequence[GainChange] = ()) -> float:
    """Return the bound of the signals of a run, whose gains were changed so."""
    ours, _ = simulate(plan, changes)

    def compare(settings: RunSettings) -> Comparison:
        theirs, _ = simulate(replace(plan, settings=settings), changes)
        comparison = Comparison()
        comparison.add_trajectories(ours.trajectory, theirs.trajectory)
        return comparison

    return _bound(plan.settings, compare)


def _bound(settings: RunSettings, compare: Callable[[RunSettings], Comparison]) -> float:
    """Return the bound from the comparisons of a run with those of other last bits."""
    largest = 0.0
    for changed in _with_other_last_bits(settings):
        try:
            largest = max(largest, compare(changed).largest)
        except FOREIGN_FAILURES:  # with these bits it has no controller, or fails
            return LARGEST
    return min(LARGEST, max(BOUND, _MARGIN * largest))


def _with_other_last_bits(settings: RunSettings) -> Iterator[RunSettings]:
    known = settings.known_scenario
    for change in _CHANGES:
        yield replace(
            settings,
            scenario=_changed(settings.scenario, change),
            known_scenario=_changed(known, change) if known else None,
        )


def _changed(scenario: Scenario, change: float) -> Scenario:
    driveline = scenario.given_driveline
    inertia = driveline.engine_inertia * (1.0 + change)
    return replace(scenario, given_driveline=replace(driveline, engine_inertia=inertia))
