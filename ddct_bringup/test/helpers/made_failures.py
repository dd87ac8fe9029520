# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Keys of campaigns that were drawn at random, and those that failures are attributed to."""

import numpy as np

from ddct_bringup.campaign_report.statistics.attribution import effects_of

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
