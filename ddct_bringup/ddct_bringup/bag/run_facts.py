"""What a recording says about its run, kept as text in the bag's custom data."""

import json
from collections.abc import Container, Mapping
from dataclasses import dataclass, fields
from typing import Any

from ddct_plant.base.errors import DdctError, ParameterError, require_name, require_number
from ddct_plant.base.timebase import steps_in
from ddct_plant.files.json_text import parse_json
from ddct_plant.graph.topics import ENGINE_REQUEST, SENSED_TOPICS, RunKind

_NAMES = ('controller', 'architecture', 'scenario', 'clutch', 'mode')
"""Facts that are plain names: they go into tables, labels and names of files."""

_LARGEST = 2.0**31
"""Of any number, in its unit; the largest seed is one less."""


MEASURED = 'measured'
"""Mode of the log of another tool, and what stands where it tells no fact."""


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
    """'lockstep' or 'realtime', MEASURED of a log of another tool."""
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

    def kind(self, *, two_input: bool, sensed: bool) -> RunKind:
        """Return what decides which topics the run has."""
        return RunKind(self.lockstep, two_input, self.clutch, sensed)

    def kind_of_bag(self, topics: Container[str]) -> RunKind:
        """Return the same of a bag that has these topics, by resolved name."""
        return self.kind(
            two_input=ENGINE_REQUEST.resolved_name in topics,
            sensed=any(topic.resolved_name in topics for topic in SENSED_TOPICS),
        )

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
        values: dict[str, Any] = {}
        for name in (field.name for field in fields(cls)):
            if name not in custom_data:
                raise DdctError(f'no {name} in the custom data: not a recording of this project')
            text = custom_data[name]
            values[name] = text if name in _NAMES else _parsed(name, text)
        return cls(**{**values, 'seed': int(values['seed'])})


def _parsed(name: str, text: str) -> Any:
    """Return the number that `text` is, or the two of the score window."""
    try:
        value = parse_json(text)
        if name == 'score_window_s':
            first, last = value
            value = (first, last)
        for number in value if isinstance(value, tuple) else (value,):
            require_number(name, number, at_least=-_LARGEST, at_most=_LARGEST)
    except (ParameterError, TypeError, ValueError) as error:
        raise DdctError(
            f'{name} is {text!r} in the custom data: not a recording of this project'
        ) from error
    return value
