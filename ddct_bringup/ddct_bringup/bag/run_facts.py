"""What a recording says about its run, kept as text in the bag's custom data."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from ddct_plant.base.checks import require_name
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.base.timebase import steps_in
from ddct_plant.files.json_text import parse_json
from ddct_plant.graph.topics import RunKind

_NAMES = ('controller', 'architecture', 'scenario', 'clutch', 'mode')
"""Facts that are plain names: they go into tables, labels and names of files."""

_LARGEST = 1e9
"""Of any number, in its unit."""


@dataclass(frozen=True)
class RunFacts:
    """The facts that scoring needs and scores repeat."""

    controller: str
    architecture: str
    scenario: str
    """Name of the scenario."""
    clutch: str
    wear_gain: float
    mode: str
    """'lockstep' or 'realtime'."""
    seed: int
    control_start_s: float
    """When feedback starts, scenario time."""
    score_window_s: tuple[float, float]
    """First and last time of the scored samples, scenario time."""
    duration_s: float
    """Length that the run was meant to have."""

    def __post_init__(self) -> None:
        """Check the names, so that a bag neither gets nor gives another; ParameterError."""
        for name in _NAMES:
            require_name(name, getattr(self, name))

    @property
    def steps(self) -> int:
        """How many periods the run was meant to have."""
        return steps_in('duration_s', self.duration_s)

    @property
    def lockstep(self) -> bool:
        """Whether every tick had to be complete."""
        return self.mode == 'lockstep'

    def kind(self, *, two_input: bool) -> RunKind:
        """Return what decides which topics the run has; only the bag's topics say `two_input`."""
        return RunKind(lockstep=self.lockstep, two_input=two_input, clutch=self.clutch)

    def to_custom_data(self) -> dict[str, str]:
        """Return the facts as text; numbers as JSON, which gives them back to the last bit."""
        return {
            field.name: value if isinstance(value, str) else json.dumps(value)
            for field in fields(self)
            for value in [getattr(self, field.name)]
        }

    @classmethod
    def from_custom_data(cls, custom_data: Mapping[str, str]) -> 'RunFacts':
        """Return the facts; raise DdctError that names a missing or unusable one."""
        missing = [field.name for field in fields(cls) if field.name not in custom_data]
        if missing:
            raise DdctError(f'no {missing[0]} in the custom data: not a recording of this project')
        first, last = _number_list('score_window_s', custom_data, 2)
        return cls(
            controller=custom_data['controller'],
            architecture=custom_data['architecture'],
            scenario=custom_data['scenario'],
            clutch=custom_data['clutch'],
            wear_gain=_number('wear_gain', custom_data),
            mode=custom_data['mode'],
            seed=int(_number('seed', custom_data)),
            control_start_s=_number('control_start_s', custom_data),
            score_window_s=(first, last),
            duration_s=_number('duration_s', custom_data),
        )


def _number(key: str, custom_data: Mapping[str, str]) -> float:
    value = _parsed(key, custom_data)
    if not _is_number(value):
        raise _unusable(key, custom_data)
    return value


def _number_list(key: str, custom_data: Mapping[str, str], length: int) -> list[float]:
    values = _parsed(key, custom_data)
    if not isinstance(values, list) or len(values) != length:
        raise _unusable(key, custom_data)
    if not all(_is_number(value) for value in values):
        raise _unusable(key, custom_data)
    return values


def _is_number(value: Any) -> bool:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    return abs(value) <= _LARGEST


def _parsed(key: str, custom_data: Mapping[str, str]) -> Any:
    try:
        return parse_json(custom_data[key])
    except ParameterError as error:
        raise _unusable(key, custom_data) from error


def _unusable(key: str, custom_data: Mapping[str, str]) -> DdctError:
    return DdctError(
        f'{key} is {custom_data[key]!r} in the custom data: not a recording of this project'
    )
