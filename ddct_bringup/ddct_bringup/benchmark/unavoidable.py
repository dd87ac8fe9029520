# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Limits that no controller can keep in a case, proven by the floor at any lock instant."""

from collections.abc import Callable, Mapping

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.conduct import require_going_on
from ddct_bringup.floor.any_lock import least_at_any_lock
from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.values import METRICS
from ddct_bringup.verdict.limits import Limits
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.input_file import parse_json
from ddct_plant.program.progress import Progress
from ddct_plant.program.workers import in_processes
from ddct_plant.scenario.settings import RunSettings


def unavoidable_limits(
    campaign: Campaign,
    limits: Limits,
    workers: int | None = None,
    stopped: Callable[[], bool] = lambda: False,
) -> Mapping[int, list[str]]:
    """
    Return the criteria whose limits no controller can keep, for each case that has floors.

    They are a property of the case: every controller starts in the same state. Raise
    KeyboardInterrupt when `stopped()` becomes true.
    """
    cases = [case for case in range(campaign.cases) if campaign.has_floors(case)]
    progress = Progress('cases with floors', len(cases))
    found = {}

    def of_case(place: int) -> list[str]:
        try:
            return unavoidable_in(campaign.run(cases[place]).settings, limits)
        except DdctError:  # a case without floors, or one that cannot be built
            return []

    with in_processes(of_case, len(cases), workers, chunk=1) as results:
        for place, names in enumerate(results):
            require_going_on(stopped)
            found[cases[place]] = names
            progress.update(place + 1)
    progress.end()
    return found


def unavoidable_in(settings: RunSettings, limits: Limits) -> list[str]:
    """Return the names of limits that no controller can keep; raise DdctError without floors."""
    start, scenario = control_start(settings), settings.scenario
    gravity = scenario.vehicle.gravity_m_s2
    return [
        name
        for name, limit in limits.of_all(scenario.name, gravity).items()
        if name in METRICS and least_at_any_lock(settings, name, start, limit.value)
    ]


def unavoidable_of(text: str, cases: int) -> dict[int, list[str]]:
    """
    Return the limits by case in the JSON of a file; there are `cases` cases.

    Raise ParameterError for a key that is no case, and for limits that are none.
    """
    content = parse_json(text)
    numbers = {str(case): case for case in range(cases)}
    if not isinstance(content, dict) or not content.keys() <= numbers.keys():
        raise ParameterError(f'its keys are not those of {cases} cases')
    for key, names in content.items():
        if not isinstance(names, list) or not all(name in (*METRICS,) for name in names):
            raise ParameterError(f'{key} is {names!r}: it must be a list of limits', key=key)
    return {numbers[key]: names for key, names in content.items()}
