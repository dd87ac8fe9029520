# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A number of a log is determined within limits of its deviation and of its shift by noise."""

from pathlib import Path

import numpy as np
import pytest

from ddct_bringup.identification.from_log.perturbed import rounded_again
from ddct_bringup.identification.from_log.unknowns import Unknowns
from ddct_bringup.logs.log import MeasuredLog


def not_determined(names: list[str], std: np.ndarray, moved: np.ndarray) -> list[str]:
    return Unknowns(names, {}, 1.0).not_determined(std, moved)


@pytest.mark.parametrize(
    ('std', 'moved', 'weak'),
    [
        (0.24, 0.0, []),
        (0.26, 0.0, ['engine_inertia']),
        (0.0, 0.09, []),
        (0.0, 0.11, ['engine_inertia']),
    ],
)
def test_noise_may_shift_a_number_by_two_fifths_of_the_deviation_that_it_may_have(
    std, moved, weak
):
    assert not_determined(['engine_inertia'], np.array([std]), np.array([moved])) == weak


def test_while_a_delay_is_weak_no_parameter_is_left_out():
    names = ['engine_inertia', 'engine_torque']
    large, none = np.full(2, 10.0), np.zeros(2)
    assert not_determined(names, large, none) == ['engine_torque']
    assert not_determined(names, large * [1.0, 0.0], none) == ['engine_inertia']


def test_a_torque_that_is_rounded_again_moves_by_half_a_step_either_way():
    step, time_s = 2.0, 0.01 * np.arange(2000)
    rounded = step * np.round(100.0 * np.sin(0.3 * time_s) / step)
    signals = {'engine_torque': rounded, 'clutch_torque': 100.0 * np.sin(0.3 * time_s)}
    logs = rounded_again(MeasuredLog(Path('a.csv'), '', time_s, signals))
    moves = np.array([log.signals['engine_torque'] - rounded for log in logs])
    assert len(logs) == 2
    np.testing.assert_allclose(np.abs(moves), 0.5 * step, rtol=1e-9)
    np.testing.assert_allclose(moves[0], -moves[1])
    assert all(log.signals['clutch_torque'] is signals['clutch_torque'] for log in logs)
