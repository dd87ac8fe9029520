# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Facts of a run that scoring needs, taken from its settings."""

from collections.abc import Container, Iterable, Mapping
from dataclasses import dataclass

from ddct_plant.base.errors import require_name
from ddct_plant.base.timebase import steps_in, time_of_step
from ddct_plant.files.input_file import located
from ddct_plant.scenario.recorded_settings import run_settings, settings_of_bag
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.signals.topic import RunKind, Topic
from ddct_plant.signals.topics import (
    ENGINE_REQUEST,
    SENSED_TOPICS,
    SHIFT_TOPICS,
    TORQUE_PARTS,
)

_NAMES = ('controller', 'architecture', 'scenario', 'mode')
"""Facts that are plain names, used in tables, labels and file names."""
MEASURED = 'measured'
"""Mode of the log of another tool, and the text for facts that such a log lacks."""


@dataclass(frozen=True)
class RunConditions:
    """Conditions of a run, which its scores repeat."""

    controller: str
    architecture: str
    scenario: str
    """Name of the scenario."""
    wear_gain: float
    mode: str
    """Mode: 'lockstep', 'realtime', or 'measured' for the log of another tool."""
    seed: int

    def __post_init__(self) -> None:
        """Raise ParameterError for a name that a bag could not store or return unchanged."""
        for name in _NAMES:
            require_name(name, getattr(self, name))


@dataclass(frozen=True)
class ShiftConditions:
    """Conditions that only a gear shift has."""

    off_going_wear_gain: float
    handover: str
    """Name of the handover."""


@dataclass(frozen=True)
class RunFacts(RunConditions):
    """Facts of a run that scoring needs."""

    control_start_s: float
    """Scenario time at which feedback starts, s."""
    score_window_s: tuple[float, float]
    """Scenario time of the first and last scored sample, s."""
    duration_s: float
    """Planned duration of the run, s."""
    clutch: str
    """Name of the clutch model, or MEASURED; it decides which topics the run has."""
    off_going_wear_gain: float | None = None
    """Wear gain of the off-going clutch of a shift; None in other runs."""
    handover: str | None = None
    """Name of the handover of a shift; None in other runs."""

    @property
    def of_shift(self) -> ShiftConditions | None:
        """Conditions of a gear shift; None of another run."""
        if self.handover is None or self.off_going_wear_gain is None:
            return None
        return ShiftConditions(self.off_going_wear_gain, self.handover)

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

    @classmethod
    def of(cls, settings: RunSettings, controller: str, steps: int) -> 'RunFacts':
        """Return the facts of a run of this many steps."""
        scenario = settings.scenario
        return cls(
            controller=controller,
            architecture=settings.known.architecture,
            scenario=scenario.name,
            wear_gain=settings.case.wear_gain,
            mode=settings.known.mode,
            seed=settings.case.seed,
            control_start_s=scenario.control_start_s,
            score_window_s=scenario.score_window_s,
            duration_s=time_of_step(steps),
            clutch=settings.known.clutch,
            off_going_wear_gain=settings.case.off_going_wear_gain if settings.shift else None,
            handover=settings.known.handover_name if settings.shift else None,
        )


def described_run(custom_data: Mapping[str, str]) -> tuple[RunSettings, RunFacts]:
    """
    Return the settings in the custom data of a bag, and the facts of the run.

    Raise DdctError for a bag without settings, and for settings that make no run.
    """
    recorded = settings_of_bag(custom_data)
    with located('settings of the run'):
        settings = run_settings(recorded.known, recorded.case)
        return settings, RunFacts.of(settings, recorded.known.controller, recorded.known.steps)
