# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The environment of Gymnasium: spaces, seeds and rewards around an episode of the loop."""

import math
import reprlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from gymnasium.spaces import Box

from ddct_bringup.api.arguments import warn_of_adjusted
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.gym.cases import DrawnCases
from ddct_bringup.gym.episode import Episode, GivenActions, Period, default_reward
from ddct_bringup.scores.document import figures_entry
from ddct_controllers.measurement import MOST
from ddct_controllers.policy import observed_names
from ddct_plant.base.errors import MOST_SIGNAL, ParameterError, require_number
from ddct_plant.base.options import require_known
from ddct_plant.scenario.settings import RunSettings

MOST_TORQUE_N_M = 500.0
"""Default end of the range of actions, in N m: above what a dry clutch of a car carries."""


class LaunchEnv(gymnasium.Env[np.ndarray, np.ndarray]):
    """
    A launch, tip-in or gear shift as a task for learners: `ddct/Launch-v0`.

    An observation is what a controller measures, in SI units (`observation_of`), an action the
    closed-loop part of the clutch torque in N m, with `two_input` C_m in N m besides. A step lasts
    until the controller is asked again, as a rule 10 ms; after lock-up it passes the rest of the
    run. `reset` draws a case, and `options={'case': {...}}` sets keys of it.
    """

    metadata: dict[str, Any] = {'render_modes': []}

    def __init__(
        self,
        *,
        scenario: str | Path | None = None,
        car: str | Path | None = None,
        drive: str | Path | None = None,
        set: Mapping[str, Any] | None = None,
        architecture: str = 'detailed',
        vary: Mapping[str, Any] | None = None,
        reward: Callable[[Period], float] = default_reward,
        two_input: bool = False,
        preview_steps: int = 0,
        most_torque_n_m: float = MOST_TORQUE_N_M,
    ) -> None:
        """
        Take the options of `run`, and the distributions of a campaign's `random.vary`.

        Without a scenario and a drive the drive is `launch`. `vary` None are the cases of the
        benchmark, and {} is the scenario as it is. `preview_steps` is the number of steps ahead of
        which the reference is observed. `most_torque_n_m` is the end of the range of the action
        space alone: a larger action is not clipped, as no controller's is. Raise DdctError for a
        value that cannot be used.
        """
        if scenario is None and drive is None:
            drive = 'launch'
        options = {'scenario': scenario, 'car': car, 'drive': drive, 'set': set}
        self._cases = DrawnCases.of(vary, {**options, 'architecture': architecture})
        if type(preview_steps) is not int or preview_steps < 0:
            raise ParameterError(
                f'preview_steps is {preview_steps!r}: give a whole number, at least 0',
                key='preview_steps',
            )
        if not callable(reward):
            raise ParameterError(
                f'reward is {reward!r}: give a function of a Period', key='reward'
            )
        self._preview_steps, self._two_input, self._reward = preview_steps, two_input, reward
        most = require_number('most_torque_n_m', most_torque_n_m, above=0.0)
        self.observed = observed_names(preview_steps)
        """Names of the numbers of an observation."""
        self.observation_space = Box(-MOST, MOST, (len(self.observed),), np.float64)
        self.action_space = Box(-most, most, (2 if two_input else 1,), np.float64)
        self._episode: Episode | None = None

    @property
    def trajectory(self) -> Trajectory:
        """Every signal of the episode, at its end those of the whole run."""
        return self._running().trajectory

    def settings_of(self, case: Mapping[str, Any]) -> RunSettings:
        """Return the settings of the run of a case, with values by key as in `info['case']`."""
        return self._cases.settings(case)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """
        Start a run of a case, at its first action; `info['case']` has the values of the case.

        Warn of given values that no car has. Raise DdctError for a case that cannot be built.
        """
        super().reset(seed=seed, options=options)
        require_known(options or {}, ('case',), 'option')
        given = dict((options or {}).get('case', {}))
        case = self._cases.draw(self.np_random) | given
        settings = self._cases.settings(case)
        if given:
            warn_of_adjusted(settings.scenario)
        actions = GivenActions(self._preview_steps, commands_engine=self._two_input)
        self._episode = Episode(settings, actions)
        return self._episode.observation, {'case': case}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """
        Act until the controller is asked again; the reward is the sum over the periods until then.

        `info['held']` is whether feedback was held off in between: a policy with a memory resets.
        An episode terminates with its run, and is never truncated: its duration is a part of the
        task, and the time is observed. Then `info` has the `state` and the `figures` of the judge.
        Raise ParameterError for an unusable action or reward, or if the run is over.
        """
        episode = self._running()
        if episode.scores:
            raise ParameterError('the run is over: call reset')
        rewards = [self._rewarded(period) for period in episode.advance(self._checked(action))]
        info: dict[str, Any] = {'held': len(rewards) > 1}
        if scores := episode.scores:
            info |= {'state': scores.state, 'figures': figures_entry(scores)}
        return episode.observation, sum(rewards), scores is not None, False, info

    def _checked(self, action: Any) -> np.ndarray:
        """Return an action as an array of finite torques in N m."""
        try:
            given = np.asarray(action, float)
        except (TypeError, ValueError):
            given = np.array(np.nan)
        if given.shape == self.action_space.shape and np.all(np.abs(given) <= MOST_SIGNAL):
            return given
        needed = (
            '2 finite numbers, as two_input is set'
            if self._two_input
            else '1 finite number in a list, or 2 with two_input=True'
        )
        text = ' '.join(reprlib.repr(action).split())
        raise ParameterError(f'action is {text}: give {needed}', key='action')

    def _rewarded(self, period: Period) -> float:
        reward = self._reward(period)
        try:
            number = float(reward)
        except (TypeError, ValueError):
            number = math.nan
        if not math.isfinite(number):
            raise ParameterError(
                f'reward returned {reward!r}: return a finite number', key='reward'
            )
        return number

    def _running(self) -> Episode:
        if self._episode is None:
            raise ParameterError('no episode is running: call reset first')
        return self._episode
