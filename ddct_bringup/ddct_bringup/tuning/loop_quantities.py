# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Quantities of a trial that no run has: its sampled loop at the corners, its update time."""

from collections.abc import Mapping, Sequence

from ddct_bringup.benchmark.update_times import REFERENCE, median_ratio
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.keys import COMMON
from ddct_bringup.tuning.specification.goals import (
    OF_LOOP,
    SENSITIVITY_PEAK,
    UNSTABLE_CORNERS,
    UPDATE_TIME,
    Goal,
)
from ddct_controllers.workflows.evidence import frequency_evidence
from ddct_controllers.workflows.evidence_types import LinearEntry
from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError, ParameterError
from ddct_plant.scenario.settings import RunSettings

Quantities = Mapping[str, float | None]
"""Values by name; None for an undefined one, as the M_s of an unstable loop."""


def nominal_settings(campaign: Campaign, cases: Sequence[int]) -> list[RunSettings]:
    """Return the settings of the first case of each scenario, clutch and architecture."""
    found: dict[tuple[str, ...], RunSettings] = {}
    for case in cases:
        run = campaign.run(case)
        kind = tuple(str(run.varied.get(key, '')) for key in COMMON)
        found.setdefault(kind, run.settings)
    return list(found.values())


def loop_quantities(
    campaign: Campaign, cases: Sequence[int], goals: Sequence[Goal]
) -> dict[str, float | None]:
    """
    Return the quantities of the sampled loop that the goals need, the worst over scenarios.

    Raise ParameterError for a controller without a frequency response; a controller that cannot be
    built with these values has none of the quantities.
    """
    if not any(goal.name in OF_LOOP for goal in goals):
        return {}
    unstable, peaks, known = 0, [], []
    for settings in nominal_settings(campaign, cases):
        scenario = settings.scenario
        plant = (scenario.driveline, scenario.actuator, scenario.controllers)
        if plant in known:
            continue
        known.append(plant)
        try:
            (entry,) = frequency_evidence(campaign.controllers, settings).controllers
        except DdctError:
            return dict.fromkeys(OF_LOOP)
        if not isinstance(entry, LinearEntry):
            raise ParameterError(
                f'{UNSTABLE_CORNERS}, {SENSITIVITY_PEAK}: {campaign.labels[0]} is not linear and '
                'has no margins: leave them out',
                key=UNSTABLE_CORNERS,
            )
        unstable = max(unstable, entry.corners.unstable_corners)
        peaks.append(entry.corners.sensitivity_peak)
    worst = None if None in peaks else max(each for each in peaks if each is not None)
    return {UNSTABLE_CORNERS: float(unstable), SENSITIVITY_PEAK: worst}


def update_time(campaign: Campaign, case: int) -> dict[str, float | None]:
    """Return the median update time over that of `pi`, in turn with it; None where it fails."""
    settings = campaign.run(case).settings
    try:
        return {UPDATE_TIME: median_ratio(campaign.controllers[0], REFERENCE, settings)}
    except FOREIGN_FAILURES:
        return {UPDATE_TIME: None}
