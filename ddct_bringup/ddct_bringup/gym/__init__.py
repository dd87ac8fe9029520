# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Environments of Gymnasium around the closed loop: importing this room registers them.

    gymnasium.make('ddct_bringup.gym:ddct/Launch-v0', drive='launch')
"""

from ddct_plant.base.errors import DdctError

try:
    from gymnasium.envs.registration import register
except ModuleNotFoundError as error:
    raise DdctError(
        'Gymnasium is not installed: run make setup EXTRAS=gym, or '
        'python -m pip install "./ddct_bringup[gym]" in the clone'
    ) from error

LAUNCH = 'ddct/Launch-v0'
"""Name of the environment of a launch, a tip-in or a gear shift."""

register(LAUNCH, entry_point='ddct_bringup.gym.environment:LaunchEnv')
