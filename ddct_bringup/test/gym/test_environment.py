# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The environment for learners is the closed loop of headless runs, within the interface."""

import warnings
from typing import Any

import numpy as np
import pytest
from extras import needs
from refusals import refused

from ddct_bringup.run.headless import run_headless
from ddct_controllers.policy import PolicyController, observed_names
from ddct_plant.base.errors import DdctError, ParameterError

pytestmark = [pytest.mark.slow, needs('gymnasium')]
SHORT = {'duration_s': 1.3}


def made(**options: Any) -> Any:
    """Return the environment without the wrappers that check each step."""
    import gymnasium

    return gymnasium.make('ddct_bringup.gym:ddct/Launch-v0', **options).unwrapped


class WithMemory(PolicyController):
    """A policy that integrates the slip, and lets go of the clutch again and again."""

    preview_steps = 2

    def reset(self) -> None:
        self._sum = 0.0

    def act(self, observation: np.ndarray) -> list[float]:
        error = observation[1] - observation[2] - observation[8]
        self._sum += 0.05 * error
        return [1.9 * error + self._sum]


class OfBoth(PolicyController):
    """A policy that commands the engine too."""

    commands_engine = True

    def act(self, observation: np.ndarray) -> list[float]:
        return [0.5 * (observation[1] - observation[2]), 0.8 * observation[5]]


def played(environment: Any, policy: PolicyController, **start: Any) -> tuple[Any, float, Any]:
    """Return the case, the sum of rewards and the last info of an episode of a policy."""
    observation, first = environment.reset(**start)
    policy.reset()
    total, over = 0.0, False
    while not over:
        observation, reward, over, _, info = environment.step(np.array(policy.act(observation)))
        total += reward
        if info['held']:
            policy.reset()
    return first['case'], total, info


def test_it_passes_the_checker_of_gymnasium() -> None:
    from gymnasium.utils.env_checker import check_env

    with warnings.catch_warnings():
        warnings.simplefilter('error')
        # Torques are in N m: gymnasium.wrappers.RescaleAction gives a learner another range.
        warnings.filterwarnings('ignore', message='.*normalized space')
        check_env(made(set=SHORT))


@pytest.mark.parametrize(
    ('policy', 'options'),
    [
        (WithMemory, {'preview_steps': 2, 'scenario': 'launch'}),
        (WithMemory, {'preview_steps': 2, 'drive': 'upshift', 'car': 'c635', 'vary': {}}),
        (OfBoth, {'two_input': True, 'set': SHORT}),
    ],
)
def test_a_policy_has_the_same_bits_in_it_and_in_a_headless_run(
    policy: type[PolicyController], options: dict[str, Any]
) -> None:
    environment = made(**options)
    case, _, info = played(environment, policy(), seed=3)
    run = run_headless(environment.settings_of(case), policy())
    assert environment.trajectory.sha256() == run.sha256()
    assert info['figures']['friction_work_j'] > 0.0


def test_a_case_is_drawn_from_the_seed_and_a_given_key_replaces_its_value() -> None:
    environment = made(set=SHORT)
    _, first = environment.reset(seed=8)
    assert environment.reset()[1] != first
    assert environment.reset(seed=8)[1] == first
    _, given = environment.reset(seed=8, options={'case': {'wear_gain': 0.7}})
    assert given['case'] == first['case'] | {'wear_gain': 0.7}
    assert 'vehicle.mass_kg' in first['case']


def test_the_reward_is_the_function_of_the_user_summed_over_the_run() -> None:
    environment = made(set=SHORT, vary={}, reward=lambda period: period.signals['slip_speed'])
    _, total, _ = played(environment, WithMemory(), seed=0)
    trajectory = environment.trajectory
    start = int(np.flatnonzero([dict(each)['feedback'] == 'on' for each in trajectory.status])[0])
    assert total == pytest.approx(trajectory.slip_speed[start:].sum())


def test_an_observation_has_the_measured_numbers_in_the_order_of_their_names() -> None:
    environment = made(set=SHORT, preview_steps=1, vary={})
    observation, _ = environment.reset(seed=0)
    assert environment.observed == observed_names(1)
    assert len(observation) == 12
    named = dict(zip(environment.observed, observation, strict=True))
    assert named['slip_reference_0'] == named['engine_speed'] - named['shaft_speed']
    assert named['time_s'] == pytest.approx(environment.settings_of({}).scenario.control_start_s)


def test_an_episode_that_is_over_or_an_unusable_action_or_reward_is_refused() -> None:
    environment = made(set=SHORT, vary={})
    environment.reset(seed=0)
    for action in ([np.nan], 1.0, [1.0, 2.0], None, 'no', [1e200]):
        with refused(ParameterError, 'action') as caught:
            environment.step(action)
        assert 'give 1 finite number in a list, or 2 with two_input=True' in str(caught.value)
    played(environment, WithMemory(), seed=0)
    assert str(environment.trajectory).startswith('<Trajectory of 131 steps: ')
    with pytest.raises(DdctError, match='the run is over: call reset'):
        environment.step([0.0])
    for reward in (lambda period: None, lambda period: np.nan):
        environment = made(set=SHORT, vary={}, reward=reward)
        environment.reset(seed=0)
        with refused(ParameterError, 'reward'):
            environment.step([0.0])
    with refused(ParameterError, 'reward'):
        made(reward=3)


def test_a_case_of_reset_is_checked_as_that_of_a_run() -> None:
    environment = made(set=SHORT)
    for options, meant in (({'cases': {}}, 'case'), ({'case': {'wear_gian': 0.7}}, 'wear_gain')):
        with pytest.raises(ParameterError, match=f'did you mean {meant}?'):
            environment.reset(seed=0, options=options)
    with pytest.warns(UserWarning, match='is it in another unit'):
        environment.reset(seed=0, options={'case': {'vehicle.mass_kg': 1.5}})


def test_an_unusable_answer_of_a_policy_is_placed_in_its_own_act() -> None:
    class Broken(PolicyController):
        answer: Any

        def act(self, observation: np.ndarray) -> Any:
            return self.answer

    line = Broken.act.__code__.co_firstlineno
    settings = made(set=SHORT, vary={}).settings_of({})
    for answer, words in (
        (None, 'act must return one number in a list, or two with commands_engine set, got None'),
        (1.0, 'got 1.0'),
        ([1.0, 2.0], 'got [1.0, 2.0]'),
        ([np.nan], 'is nan'),
    ):
        policy = Broken()
        policy.answer = answer
        with pytest.raises(DdctError) as caught:
            run_headless(settings, policy)
        assert words in str(caught.value)
        assert f'test_environment.py line {line}' in str(caught.value)


def test_what_cannot_be_used_is_refused_with_its_key() -> None:
    with refused(ParameterError, 'preview_steps'):
        made(preview_steps=-1)
    with refused(ParameterError, 'random.vary.wear_gain.high'):
        made(vary={'wear_gain': {'distribution': 'uniform', 'low': 0.7}})
    with pytest.raises(DdctError, match='reset'):
        made(vary={}).step(np.zeros(1))
