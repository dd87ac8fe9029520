# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The settings that a run may have beside its scenario, as options; cheap to import."""

from dataclasses import replace

from ddct_plant.base.clutch_kinds import WEAR_GAIN
from ddct_plant.base.options import Option, Options

ARCHITECTURES = ('base', 'feedforward', 'feedforward_tanh', 'detailed')
"""Names of the control architectures: those of Section 1.6, and CRF's detailed model (1.4)."""
MODES = ('lockstep', 'realtime')
"""Modes of a run: lock-step waits for every reply; real time steps at 100 Hz and counts misses."""
SETTINGS: Options = {
    'architecture': Option('detailed', 'control architecture', choices=ARCHITECTURES),
    'wear_gain': WEAR_GAIN,
    'mode': Option('lockstep', 'wait for every node, or 100 Hz on the wall clock', choices=MODES),
    'seed': Option(
        0,
        'seed of the random numbers of `sensors`; without sensors it changes nothing',
        at_least=0,
        at_most=2**31 - 1,
    ),
    'off_going_wear_gain': replace(
        WEAR_GAIN, meaning='wear gain of the off-going clutch, in a gear shift only'
    ),
    'handover': Option(
        'adaptive',
        'how the torque goes from the off-going to the on-coming clutch, in a gear shift only: '
        'timed, slip, model, adaptive, one of another package, or a Python file',
    ),
}
"""Options of `RunSettings` by name."""
