# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""One run of the closed loop that waits for the action of each step, and its reward."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.execution import recording_in_memory
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.scoring import score_run
from ddct_bringup.verdict.limits import load_limits
from ddct_bringup.verdict.state import ENGAGED
from ddct_controllers.loop import ClosedLoop
from ddct_controllers.policy import PolicyController, observation_of
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.signals.topic import SignalValue

SLIP_RAD_S, JERK_M_S3, FAILURE = 100.0, 10.0, 10.0
"""
Slip from which a second costs 1, jerk at which a second costs 1, and the cost of a failed run.

A run that never closes slips to its end, and one that stalls ends early: both cost more than a
slow or a rough engagement does.
"""


@dataclass(frozen=True)
class Period:
    """A period of 10 ms of an episode, for a reward: it may use what no controller measures."""

    before: DrivelineOutputs
    """True signals of the driveline at the start of the period."""
    after: DrivelineOutputs
    """The same at its end; at the end of the run those of its start."""
    signals: Mapping[str, SignalValue]
    """Every signal of the run at the start of the period, by name."""
    state: str | None
    """State of the run by the judge at the end of the run; None before."""


def default_reward(period: Period) -> float:
    """
    Return less the cost of a period: its time by |w_d| over 100 rad/s and by |jerk| over 10 m/s^3.

    To that 10 is added at the end of a run that is not `engaged`.
    """
    slip = abs(period.before.slip_speed) / SLIP_RAD_S
    jerk = abs(period.after.vehicle_accel - period.before.vehicle_accel) / PERIOD_S / JERK_M_S3
    cost = PERIOD_S * (slip + jerk)
    return -cost - (FAILURE if period.state not in (None, ENGAGED) else 0.0)


class GivenActions(PolicyController):
    """The policy of a learner, which gives each action from outside."""

    def __init__(self, preview_steps: int, *, commands_engine: bool) -> None:
        """Take the two attributes of a controller."""
        super().__init__()
        self.preview_steps, self.commands_engine = preview_steps, commands_engine
        self.action = np.zeros(0)
        """Torques in N m for the coming period."""

    def act(self, observation: np.ndarray) -> np.ndarray:
        """Return the given action."""
        return self.action


class Episode:
    """
    A run of the closed loop that stops at each step at which the controller is asked.

    Steps with feedback held off, before control start and after lock-up, pass by themselves.
    """

    def __init__(self, settings: RunSettings, actions: GivenActions) -> None:
        """Go to the first action; raise DdctError for a run that asks for none."""
        self._settings, self._actions = settings, actions
        self._loop = ClosedLoop(settings, actions)
        self._steps = self._loop.steps(settings.scenario.steps)
        self._rows: list[dict[str, SignalValue]] = []
        self._observed = next(self._steps)
        self._asked = self._loop.ask(self._observed)
        self.scores: ScoredRun | None = None
        """Scores of the run once it has ended; None before."""
        self.passed = [*self._to_next_action()]
        """Periods before the first action."""
        if self.scores:
            raise DdctError(
                f'scenario {settings.scenario.name}: feedback is never on in this run: make it '
                'last longer than its control start'
            )

    @property
    def observation(self) -> np.ndarray:
        """What the controller measures at the present step, in SI units."""
        return observation_of(self._asked.asked.measurement)

    @property
    def trajectory(self) -> Trajectory:
        """Every signal of the run as far as it has come."""
        return Trajectory.of_rows(self._rows, self._loop.kind)

    def advance(self, action: np.ndarray) -> list[Period]:
        """
        Take an action in N m; return the periods until the next one, or the end.

        Raise DdctError for an action that is not finite.
        """
        self._actions.action = action
        # As `run_loop`: what is not finite ends the run with a reason.
        with np.errstate(over='ignore', invalid='ignore'):
            return [self._answer(), *self._to_next_action()]

    def _to_next_action(self) -> Iterator[Period]:
        while not self.scores and not self._asked.asked.on:
            yield self._answer()

    def _answer(self) -> Period:
        """Answer the present step and go to the next."""
        reply = self._loop.answer(self._observed, self._loop.requested(self._asked))
        self._rows.append(reply.signals)
        before = self._observed.observation.tick.true
        if (observed := next(self._steps, None)) is None:
            self.scores = self._scored()
            return Period(before, before, reply.signals, self.scores.state)
        self._observed, self._asked = observed, self._loop.ask(observed)
        return Period(before, observed.observation.tick.true, reply.signals, None)

    def _scored(self) -> ScoredRun:
        name = type(self._actions).__name__
        recording = recording_in_memory(self._settings, name, self.trajectory)
        return score_run(recording, name, load_limits(None), RunTiming())
