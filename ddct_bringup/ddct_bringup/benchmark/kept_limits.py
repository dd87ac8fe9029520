# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Share of the avoidable limits that a controller kept."""

from collections.abc import Iterator, Mapping
from functools import cache

import numpy as np

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.outcomes import share_of, successes_in
from ddct_bringup.benchmark.result_types import LimitsResult
from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.campaign.rows import CRITERION
from ddct_bringup.metrics.catalogue import CRITERIA
from ddct_bringup.verdict.limits import TRACTION, Limit, Limits
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import STICK_SLIP

_COLUMNS = {
    **{each.key: each.metric or f'{CRITERION}{each.key}' for each in CRITERIA},
    TRACTION: f'{CRITERION}{TRACTION}',
}
"""Columns of the criteria by their names, and that of the traction."""


def limits_in(
    rows: CaseRows, controller: str, unavoidable: Mapping[int, list[str]], limits: Limits
) -> LimitsResult:
    """
    Return which limits a controller kept, in the cases that `unavoidable` has.

    A run that is no success keeps none. The limit of a criterion or of the traction counts in a
    case where one of the controllers has a value, and of a success where it has one itself.
    """
    success = successes_in(rows.of(controller))
    place = rows.controllers.index(controller)
    kept = avoidable = all_kept = 0
    for case, names in unavoidable.items():
        results = [
            bool(success[case] and abs(values[place]) <= limit.value)
            for limit, values in _limits_of(rows, case, limits)
            if limit.criterion not in names and not (success[case] and np.isnan(values[place]))
        ]
        kept += sum(results)
        avoidable += len(results)
        all_kept += success[case] and all(results)
    return {
        'runs': len(unavoidable),
        'unavoidable': sum(map(len, unavoidable.values())),
        'avoidable': avoidable,
        'kept': kept,
        'share': kept / avoidable if avoidable else None,
        'all_kept': share_of(int(all_kept), len(unavoidable)),
    }


def _limits_of(rows: CaseRows, case: int, limits: Limits) -> Iterator[tuple[Limit, np.ndarray]]:
    """Yield the limits of a case with the values of all controllers, (controllers,)."""
    (scenario,) = set(rows.columns[SCENARIO][:, case].tolist())
    for name, limit in limits.of_all(scenario, _gravity(scenario)).items():
        column = rows.columns.get(_COLUMNS[name])
        if column is not None and not np.isnan(values := column[:, case]).all():
            yield limit, values


@cache
def _gravity(scenario: str) -> float:
    """Return the gravity in m/s^2 in a scenario, which no case varies."""
    return load_scenario(scenario, clutch=STICK_SLIP).vehicle.gravity_m_s2
