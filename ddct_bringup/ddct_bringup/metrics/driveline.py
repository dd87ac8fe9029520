# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Criteria of oscillations of the driveline: judder, shuffle and torque dip."""

from ddct_bringup.bag.measured_run import TORSION
from ddct_bringup.metrics.metric import criterion
from ddct_bringup.metrics.signals.vibration import SHORTEST_JUDDER_S, torque_dip

_NOT_TOGETHER = 'the plates never came together after control start'

QUANTITIES = (
    criterion(
        'judder',
        'rpm',
        lambda engagement: engagement.judder,
        'r.m.s. of w_sr from 2 to 20 Hz from the first to the last sample of slipping after '
        'control start, of a linear clutch before t_a',
        f'the clutch slips for less than {SHORTEST_JUDDER_S:g} s after control start',
        exists=lambda engagement: engagement.slips_for_judder,
        needs=(TORSION,),
    ),
    criterion(
        'shuffle_amplitude',
        'rpm',
        lambda engagement: engagement.shuffle[0],
        'largest magnitude of w_sr once the plates are together',
        _NOT_TOGETHER,
        needs=(TORSION,),
    ),
    criterion(
        'shuffle_decay',
        's',
        lambda engagement: engagement.shuffle[1],
        'from there until w_sr stays below 1/e of it',
        f'{_NOT_TOGETHER}, or w_sr has not decayed when the run ends',
        needs=(TORSION,),
    ),
    criterion(
        'torque_dip',
        'N m',
        lambda engagement: torque_dip(engagement.driveshaft_torque),
        "largest fall of the driveshaft's torque after control start",
        'the run ends before control start',
        needs=('driveshaft_torque',),
    ),
)
