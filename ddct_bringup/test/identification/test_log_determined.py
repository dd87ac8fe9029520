# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A number of a log is determined within limits of its deviation and of its shift by noise."""

import numpy as np
import pytest

from ddct_bringup.identification.from_log.unknowns import Unknowns


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
