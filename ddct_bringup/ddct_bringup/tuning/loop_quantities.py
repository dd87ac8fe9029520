# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Quantities of a trial that no run has: its sampled loop at the corners, its update time."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

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
from ddct_controllers.design.analysis.worst_corner import CornerLoops, plant_corners
from ddct_controllers.registry import Chosen
from ddct_controllers.workflows.evidence import linear_model
from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError, ParameterError
from ddct_plant.scenario.settings import RunSettings

Quantities = Mapping[str, float | None]
"""Values by name; None for an undefined one, as the M_s of an unstable loop."""

_QUANTITY: Mapping[str, Callable[[CornerLoops], float | None]] = {
    UNSTABLE_CORNERS: lambda loops: float(np.count_nonzero(loops.unstable)),
    SENSITIVITY_PEAK: lambda loops: loops.sensitivity_peak,
}
"""Quantities of the loops at the corners by name."""


def nominal_settings(campaign: Campaign, cases: Sequence[int]) -> list[RunSettings]:
    """Return the settings of the first case of each scenario, clutch and architecture."""
    varied = campaign.varied(range(campaign.cases))
    first: dict[tuple[str, ...], int] = {}
    for case in cases:
        first.setdefault(tuple(str(varied[case].get(key, '')) for key in COMMON), case)
    return [campaign.run(case).settings for case in first.values()]


def loop_quantities(
    campaign: Campaign, cases: Sequence[int], goals: Sequence[Goal]
) -> dict[str, float | None]:
    """
    Return the quantities of the sampled loop that the goals need, the worst over scenarios.

    Raise ParameterError for a controller without a frequency response; a controller that cannot be
    built with these values has none of the quantities.
    """
    names = sorted({goal.name for goal in goals if goal.name in OF_LOOP})
    found: list[dict[str, float | None]] = []
    known = []
    for settings in nominal_settings(campaign, cases) if names else ():
        scenario = settings.scenario
        plant = (scenario.driveline, scenario.actuator, scenario.controllers)
        if plant in known:
            continue
        known.append(plant)
        try:
            values = _at_corners(names, campaign.controllers[0], settings)
        except (DdctError, np.linalg.LinAlgError):
            return dict.fromkeys(names)
        if values is None:
            raise ParameterError(
                f'{UNSTABLE_CORNERS}, {SENSITIVITY_PEAK}: {campaign.labels[0]} is not linear and '
                'has no margins: leave them out',
                key=UNSTABLE_CORNERS,
            )
        found.append(values)
    return {name: _worst([each[name] for each in found]) for name in names}


def _at_corners(
    names: Sequence[str], chosen: Chosen, settings: RunSettings
) -> dict[str, float | None] | None:
    """Return quantities of the loops at the corners, None where the controller is not linear."""
    linear = linear_model(chosen, settings)
    if linear is None:
        return None
    _, model = linear
    scenario = settings.scenario
    loops = CornerLoops(model, plant_corners(scenario.driveline, scenario.actuator))
    return {name: _QUANTITY[name](loops) for name in names}


def _worst(values: Sequence[float | None]) -> float | None:
    """Return the largest value, None where one is undefined."""
    return None if None in values else max(each for each in values if each is not None)


def update_time(campaign: Campaign, case: int) -> dict[str, float | None]:
    """Return the median update time over that of `pi`, in turn with it; None where it fails."""
    settings = campaign.run(case).settings
    try:
        return {UPDATE_TIME: median_ratio(campaign.controllers[0], REFERENCE, settings)}
    except FOREIGN_FAILURES:
        return {UPDATE_TIME: None}
