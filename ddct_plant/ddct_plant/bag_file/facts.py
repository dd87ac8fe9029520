# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Numbers in the custom data of a bag, and a check of its duration that all readers share."""

from collections.abc import Mapping
from typing import Any

from ddct_plant.base.errors import DdctError, ParameterError, require_number
from ddct_plant.base.timebase import LONGEST_S, steps_in, time_of_step
from ddct_plant.files.json_records import parse_json
from ddct_plant.files.yaml_text import parse_yaml

DURATION = 'duration_s'
"""Key of the planned duration in s, in the custom data and in the scenario."""
SCENARIO, KNOWN_SCENARIO = 'scenario_yaml', 'known_scenario_yaml'
"""Key of the scenario's text in the custom data."""
_LARGEST = 2.0**31
"""Upper bound of any number, in its unit; the largest seed is one less."""


def parsed_fact(name: str, text: str) -> Any:
    """Return the number in `text`, or the two numbers of the score window; raise DdctError."""
    try:
        value = parse_json(text)
        if name == 'score_window_s':
            first, last = value
            value = (first, last)
        for number in value if isinstance(value, tuple) else (value,):
            require_number(name, number, at_least=-_LARGEST, at_most=_LARGEST)
    except (ParameterError, TypeError, ValueError) as error:
        raise DdctError(
            f'{name} is {text!r} in the custom data: not a recording of this project', key=name
        ) from error
    return value


def recorded_scenario(custom_data: Mapping[str, str], key: str = SCENARIO) -> Any:
    """Return the content of the scenario recorded under a key; None without a readable one."""
    try:
        return parse_yaml(custom_data.get(key, ''))
    except DdctError:
        return None


def planned_steps(custom_data: Mapping[str, str]) -> int | None:
    """
    Return the planned number of periods of a bag, None of a bag of another recorder.

    Raise DdctError for a duration that no run has.
    """
    if DURATION not in custom_data:
        return None
    duration_s = parsed_fact(DURATION, custom_data[DURATION])
    if not 0.0 < duration_s <= LONGEST_S:
        raise DdctError(
            f'{DURATION} is {duration_s:g} in the custom data, of runs it is above 0 and at most '
            f'{LONGEST_S:g}: take the original bag',
            key=DURATION,
        )
    return steps_in(DURATION, duration_s)


def require_duration(custom_data: Mapping[str, str]) -> None:
    """Raise DdctError for a duration that no run has, or that is beyond the scenario's."""
    steps = planned_steps(custom_data)
    scenario = recorded_scenario(custom_data)
    longest = scenario.get(DURATION) if isinstance(scenario, dict) else None
    if steps and isinstance(longest, int | float) and time_of_step(steps) > longest:
        raise contradiction(
            DURATION, time_of_step(steps), longest, 'in that of the recorded scenario'
        )


def require_last_step(custom_data: Mapping[str, str], last: int) -> None:
    """Raise DdctError for messages up to the step `last`, after the end of the planned run."""
    steps = planned_steps(custom_data)
    if steps is not None and last > steps:
        raise contradiction(DURATION, time_of_step(steps), time_of_step(last), 'at its last tick')


def contradiction(name: str, ours: object, theirs: object, where: str) -> DdctError:
    """Return the error for a fact that another part of the bag contradicts."""
    return DdctError(
        f'{name} is {ours} in its custom data and {theirs} {where}: it was edited, '
        'take the original',
        key=name,
    )
