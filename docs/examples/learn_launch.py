# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Train a small policy to engage the clutch, by a cross-entropy search with numpy alone.

It takes a minute, and writes the policy as a controller file, by default `learnt.py`.
"""

import argparse
import inspect
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

from ddct_controllers.policy import PolicyController

GENERATIONS, POPULATION, BEST, CASES = 16, 24, 6, 4
HEAD = 'import numpy as np\nfrom ddct_controllers.policy import PolicyController\n\n'


class Learnt(PolicyController):
    """A weighted sum of six numbers that are measured, limited to 200 N m."""

    weights: np.ndarray = np.zeros(6)

    def act(self, observation: np.ndarray) -> list[float]:
        """Return the closed-loop part of the clutch torque in N m."""
        time_s, engine_speed, shaft_speed = observation[:3]
        torque, slip, slip_reference = observation[5], engine_speed - shaft_speed, observation[8]
        numbers = [1, slip / 100, (slip - slip_reference) / 20, observation[9] / 100]
        return [200 * np.tanh(self.weights @ [*numbers, torque / 200, time_s])]


def reward_of(environment: Any, policy: Learnt, seeds: Iterable[int]) -> float:
    """Return the mean reward of a policy over the cases of the seeds."""
    rewards = []
    for seed in seeds:
        observation, _ = environment.reset(seed=int(seed))
        total, over = 0.0, False
        while not over:
            observation, reward, over, _, _ = environment.step(np.array(policy.act(observation)))
            total += reward
        rewards.append(total)
    return float(np.mean(rewards))


def write(file: Path, weights: np.ndarray) -> None:
    """Write the policy with these weights as a controller file."""
    source = inspect.getsource(Learnt).replace('np.zeros(6)', f'np.array({weights.tolist()})')
    file.write_text(f'{HEAD}\n{source}', encoding='utf-8')


def search(environment: Any, generations: int, file: Path) -> None:
    """Search weights; after each generation write those around which its best are."""
    random, policy = np.random.default_rng(0), Learnt()
    mean, deviation = np.zeros(6), 0.7 * np.ones(6)
    for generation in range(generations):
        seeds = random.integers(2**31, size=CASES)
        tried = mean + deviation * random.standard_normal((POPULATION, 6))
        rewards = []
        for policy.weights in tried:
            rewards.append(reward_of(environment, policy, seeds))
        best = tried[np.argsort(rewards)[-BEST:]]
        mean, deviation = best.mean(axis=0), best.std(axis=0) + 0.02
        write(file, mean)
        print(f'generation {generation + 1}: best reward {max(rewards):.2f}', flush=True)


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument('file', nargs='?', type=Path, default=Path('learnt.py'))
parser.add_argument('generations', nargs='?', type=int, default=GENERATIONS)
given = parser.parse_args()
file = given.file
if file.suffix != '.py' or not file.parent.is_dir():
    parser.error(f'{file}: give a file that ends with .py, in a folder that exists')
if given.generations < 1:
    parser.error('generations: give at least 1')
# Without the checker of Gymnasium, which would look at each step.
environment = gymnasium.make('ddct_bringup.gym:ddct/Launch-v0', disable_env_checker=True)
search(environment, given.generations, file)
print(f'{file}: judge it by ddct benchmark {file} --quick --out results/learnt')
