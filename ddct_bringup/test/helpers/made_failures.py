# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Keys of campaigns that were drawn at random, and those that failures are attributed to."""

import numpy as np

from ddct_bringup.evaluation.attribution import effects_of

KEYS = ('wear_gain', 'vehicle.mass_kg', 'actuator.delay_s', 'load.slope_rad', 'gear', 'noise')
NAMES = ('thesis', 'launch', 'launch_hot', 'launch_hill', 'tip_in', 'upshift', 'upshift_hot')
RUNS = 400


def drawn(seed, runs=RUNS):
    """Return six keys that were drawn independently, one of them with five values."""
    random = np.random.default_rng(seed)
    values = {key: random.uniform(size=runs) for key in KEYS}
    return {**values, 'gear': random.integers(1, 6, runs).astype(float)}


def blamed(values, failed):
    """Return the keys that drive failure."""
    return [each.key for each in effects_of(values, failed) if each.drives]


def wrongly_blamed(campaigns):
    """Return in how many campaigns a key drives failures that no key causes."""
    wrong = 0
    for seed in range(campaigns):
        failed = np.random.default_rng([1, seed]).random(RUNS) < 0.1
        names = np.random.default_rng([4, seed]).choice(NAMES, RUNS)
        wrong += bool(blamed({**drawn(seed), 'scenario': names}, failed))
    return wrong


def covered_effects(campaigns):
    """Return in how many campaigns the interval of the wear gain covers its main effect."""
    slope, mean = 0.4, 0.2
    true = slope**2 / 12 / (mean * (1 - mean))  # failure has the chance 0.4 (1 - wear)
    covered = 0
    for seed in range(campaigns):
        values = drawn(seed)['wear_gain']
        failed = np.random.default_rng([2, seed]).random(RUNS) < slope * (1.0 - values)
        (wear,) = effects_of({'wear_gain': values}, failed)
        covered += wear.interval[0] <= true <= wear.interval[1]
    return covered
