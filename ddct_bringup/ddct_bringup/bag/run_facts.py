"""What a recording says about its run: facts as text, the nodes' own words, real-time counts."""

import json
from collections.abc import Container, Iterable, Mapping
from dataclasses import dataclass, field, fields
from typing import Any

from ddct_plant.base.errors import DdctError, ParameterError, require_name, require_number
from ddct_plant.base.timebase import steps_in
from ddct_plant.files.input_file import parse_json
from ddct_plant.graph.topics import (
    ENGINE_REQUEST,
    SAFE_STATE,
    SENSED_TOPICS,
    SINCE,
    TICKS_STATUS,
    RunKind,
)

_NAMES = ('controller', 'architecture', 'scenario', 'clutch', 'mode')
"""Facts that are plain names: they go into tables, labels and names of files."""

_LARGEST = 2.0**31
"""Of any number, in its unit; the largest seed is one less."""

MEASURED = 'measured'
"""Mode of the log of another tool, and what stands where it tells no fact."""

RunInfoOfNodes = dict[str, Mapping[str, str]]
"""Per node name what it says of itself on `run_info`."""

_CONTROLLER_NODE = 'controller'


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
            each.name: value if isinstance(value, str) else json.dumps(value)
            for each in fields(self)
            for value in [getattr(self, each.name)]
        }

    @classmethod
    def from_custom_data(cls, custom_data: Mapping[str, str]) -> 'RunFacts':
        """Return the facts; raise DdctError that names a missing or unusable one."""
        values: dict[str, Any] = {}
        for name in (each.name for each in fields(cls)):
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


@dataclass
class RealtimeCounts:
    """What the driveline counts in a real-time run, and who went to its safe state."""

    missed_steps: int = 0
    """Steps that had to hold a torque."""
    resends: int = 0
    """Ticks that were sent again."""
    late_messages: int = 0
    """Replies to a tick that was over."""
    worst_lateness_us: float | None = None
    """How much too late the driveline took a step at most; None in lock-step."""
    safe_states: dict[str, int] = field(default_factory=dict)
    """Per node that went to its safe state the stamp in ns since when."""


@dataclass
class RealtimeFacts(RealtimeCounts):
    """The last that a real-time run says on `/diagnostics`, live and in its bag."""

    steps: int = 0
    """Step at which the driveline counted."""

    def hear(self, name: str, pairs: Mapping[str, str]) -> bool:
        """Take one status; say whether it was one of ours."""
        try:
            if name.endswith(SAFE_STATE):
                self.safe_states[name.removesuffix(SAFE_STATE)] = int(pairs[SINCE])
                return True
            if name != TICKS_STATUS:
                return False
            for count in ('steps', 'missed_steps', 'resends', 'late_messages'):
                setattr(self, count, int(pairs[count]))
            if 'worst_tick_lateness_us' in pairs:
                self.worst_lateness_us = float(pairs['worst_tick_lateness_us'])
        except (KeyError, ValueError):
            return False
        return True


def note_run_info(said: RunInfoOfNodes, node: str, pairs: Mapping[str, str]) -> None:
    """
    Add what `node` says on `run_info`.

    Raise DdctError when a node of this name has said another thing.
    """
    before = said.setdefault(node, pairs)
    if pairs == before:
        return
    key = next(key for key in (*before, *pairs) if before.get(key) != pairs.get(key))
    raise DdctError(
        f'run_info of node {node} came twice, with {key} {before.get(key, "missing")} and '
        f'{pairs.get(key, "missing")}: two nodes had this name, record the run again with one of '
        'them, or in another ROS_DOMAIN_ID'
    )


def run_info_order(nodes: Iterable[str]) -> list[str]:
    """
    Return the names of the nodes sorted, `controller` last.

    Viewers such as Foxglove keep only the last message of a topic when they are opened or moved
    in time; the controller's is the one that says which controller runs, and with which gains.
    """
    return sorted(nodes, key=lambda node: (node == _CONTROLLER_NODE, node))
