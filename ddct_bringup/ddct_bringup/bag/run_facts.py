# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Facts of a run, and the custom data of a bag that have them as text."""

import json
from collections.abc import Container, Iterable, Mapping
from dataclasses import dataclass, fields
from typing import Any, TypedDict

from ddct_plant.bag_file.facts import parsed_fact
from ddct_plant.base.errors import DdctError, ParameterError, require_name
from ddct_plant.base.timebase import steps_in
from ddct_plant.scenario.settings import is_handover_file
from ddct_plant.signals.signal import RunKind
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import (
    ENGINE_REQUEST,
    SENSED_TOPICS,
    SHIFT_TOPICS,
    TORQUE_PARTS,
)

_NAMES = ('controller', 'architecture', 'scenario', 'clutch', 'mode')
"""Facts that are plain names, used in tables, labels and file names."""
_OF_SHIFTS = ('off_going_wear_gain', 'handover')
"""Facts that only a shift has."""
MEASURED = 'measured'
"""Mode of the log of another tool, and the text for facts that such a log lacks."""


@dataclass(frozen=True)
class RunConditions:
    """Conditions of a run, which its scores repeat."""

    controller: str
    architecture: str
    scenario: str
    """Name of the scenario."""
    clutch: str
    wear_gain: float
    mode: str
    """Mode: 'lockstep', 'realtime', or MEASURED for the log of another tool."""
    seed: int

    def __post_init__(self) -> None:
        """Raise ParameterError for a name that a bag could not store or return unchanged."""
        for name in _NAMES:
            require_name(name, getattr(self, name))


class ShiftOptions(TypedDict, total=False):
    """Fields of `RunSettings` that only a shift sets; empty for another run."""

    off_going_wear_gain: float
    handover: str


@dataclass(frozen=True)
class RunFacts(RunConditions):
    """Facts of a run that scoring needs."""

    control_start_s: float
    """Scenario time at which feedback starts, s."""
    score_window_s: tuple[float, float]
    """Scenario time of the first and last scored sample, s."""
    duration_s: float
    """Planned duration of the run, s."""
    off_going_wear_gain: float | None = None
    """Wear gain of the off-going clutch of a shift; None in other runs."""
    handover: str | None = None
    """Name of the handover of a shift; None in other runs."""

    def __post_init__(self) -> None:
        """Raise ParameterError for a name that a bag could not store or return unchanged."""
        super().__post_init__()
        if self.handover is not None:
            require_name('handover', self.handover)
            if is_handover_file(self.handover):  # a bag is data alone: its facts run no file
                raise ParameterError(
                    f'handover is {self.handover!r}, a file: give a name without .py',
                    key='handover',
                )

    @property
    def of_shift(self) -> ShiftOptions:
        """Settings of a shift by name; none of another run."""
        if self.handover is None or self.off_going_wear_gain is None:
            return {}
        return {'off_going_wear_gain': self.off_going_wear_gain, 'handover': self.handover}

    @property
    def steps(self) -> int:
        """Planned number of periods."""
        return steps_in('duration_s', self.duration_s)

    @property
    def lockstep(self) -> bool:
        """Whether every tick must be complete, as in lock-step."""
        return self.mode == 'lockstep'

    def kind(
        self,
        *,
        two_input: bool,
        sensed: bool,
        shift: bool = False,
        torque_parts: bool = True,
    ) -> RunKind:
        """Return the kind of the run, which decides which topics it has."""
        return RunKind(self.lockstep, two_input, self.clutch, sensed, shift, torque_parts)

    def kind_of_bag(self, topics: Container[str]) -> RunKind:
        """Return the kind of run of a bag that has these topics, given by resolved name."""

        def has_any(candidates: Iterable[Topic]) -> bool:
            return any(topic.resolved_name in topics for topic in candidates)

        return self.kind(
            two_input=has_any([ENGINE_REQUEST]),
            sensed=has_any(SENSED_TOPICS),
            shift=has_any(SHIFT_TOPICS),
            torque_parts=has_any([TORQUE_PARTS]),
        )

    def to_custom_data(self) -> dict[str, str]:
        """Return the facts as text by name; numbers as JSON, which keeps them to the last bit."""
        return {
            each.name: value if isinstance(value, str) else json.dumps(value)
            for each in fields(self)
            for value in [getattr(self, each.name)]
            if value is not None
        }

    @classmethod
    def from_custom_data(cls, custom_data: Mapping[str, str]) -> 'RunFacts':
        """Return the facts in a bag's custom data; DdctError names a missing or invalid one."""
        values: dict[str, Any] = {}
        for name in (each.name for each in fields(cls)):
            if name not in custom_data:
                if name in _OF_SHIFTS:
                    continue
                raise DdctError(
                    f'no {name} in the custom data: not a recording of this project', key=name
                )
            text = custom_data[name]
            values[name] = text if name in (*_NAMES, 'handover') else parsed_fact(name, text)
        return cls(**{**values, 'seed': int(values['seed'])})
