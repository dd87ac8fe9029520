# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Two results are the same to the last bit, within the bound, or different from a step on."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.verification.comparison import Comparison, recorded_json
from ddct_bringup.verification.states import BOUND, DIFFERENT, SAME_BITS, SAME_WITHIN
from ddct_plant.base.errors import DdctError

STATUS = tuple((('iterations', '3'), ('cost', '1.5')) for _ in range(4))


def run(**changes: Any) -> Trajectory:
    signals: dict[str, Any] = {
        'slip_speed': np.array([100.0, 50.0, 1e-3, 0.0]),
        'joint_speed': np.ones((4, 2)),
        'status': STATUS,
    }
    return Trajectory({**signals, **changes})


def compared(other: Trajectory) -> Comparison:
    comparison = Comparison()
    comparison.add_trajectories(run(), other)
    return comparison


def test_equal_runs_have_the_same_bits() -> None:
    assert compared(run()).state(same_environment=True) == SAME_BITS
    assert compared(run()).first(same_environment=True) is None


def test_a_last_bit_counts_only_where_code_and_processor_agree() -> None:
    near = np.array([100.0, np.nextafter(50.0, 99.0), 1e-3, 0.0])
    comparison = compared(run(slip_speed=near))
    assert comparison.state(same_environment=False) == SAME_WITHIN
    assert comparison.first(same_environment=False) is None
    assert 0.0 < comparison.largest < 1e-15
    assert comparison.state(same_environment=True) == DIFFERENT
    first = comparison.first(same_environment=True)
    assert first is not None
    assert first.entry() == {
        'signal': 'slip_speed',
        'step': 1,
        'recorded': 50.0,
        'repeated': near[1],
    }


def test_the_bound_is_relative_to_the_largest_value_of_the_signal() -> None:
    for share, state in ((0.9, SAME_WITHIN), (1.1, DIFFERENT)):
        near = np.array([100.0, 50.0, 1e-3 + share * BOUND * 100.0, 0.0])
        assert compared(run(slip_speed=near)).state(same_environment=False) == state


def test_the_first_difference_is_that_of_the_earliest_step_of_any_signal() -> None:
    slip = np.array([100.0, 50.0, 1e-3, 5.0])
    joints = np.ones((4, 2))
    joints[2, 1] = 2.0
    first = compared(run(slip_speed=slip, joint_speed=joints)).first(same_environment=True)
    assert first is not None
    assert first.place == {'signal': 'joint_speed', 'step': 2}


@pytest.mark.parametrize(
    ('changes', 'place'),
    [
        ({'slip_speed': np.array([100.0, 50.0])}, {'signal': 'slip_speed', 'step': 2}),
        ({'joint_speed': np.ones((4, 3))}, {'signal': 'joint_speed', 'step': 0}),
        ({'engine_torque': np.zeros(4)}, {'signal': 'engine_torque', 'step': 0}),
        (
            {'slip_speed': np.array([100.0, math.nan, 1e-3, 0.0])},
            {'signal': 'slip_speed', 'step': 1},
        ),
        (
            {'status': (*STATUS[:3], (('iterations', '4'), ('cost', '1.5')))},
            {'signal': 'status', 'step': 3},
        ),
        (
            {'status': (*STATUS[:3], (('iterations', '3'), ('price', '1.5')))},
            {'signal': 'status', 'step': 3},
        ),
    ],
)
def test_another_length_size_signal_or_word_is_different(
    changes: dict[str, Any], place: dict[str, Any]
) -> None:
    first = compared(run(**changes)).first(same_environment=False)
    assert first is not None
    assert first.place == place


def test_numbers_in_texts_have_the_bound_too() -> None:
    near = (*STATUS[:3], (('iterations', '3'), ('cost', '1.5000000000001')))
    assert compared(run(status=near)).state(same_environment=False) == SAME_WITHIN


@pytest.mark.parametrize(
    ('recorded', 'repeated', 'state'),
    [
        (1.0, 1.0, SAME_BITS),
        (None, None, SAME_BITS),
        (1.0, 1.0 + 1e-12, SAME_WITHIN),
        (1e6, 1e6 + 1e-4, SAME_WITHIN),
        (0.0, 1e-12, SAME_WITHIN),
        (1.0, 1.0 + 1e-8, DIFFERENT),
        (None, 1.0, DIFFERENT),
        (True, 1, DIFFERENT),
        (10**400, 1.0, DIFFERENT),
        ('engaged', 'stalled', DIFFERENT),
        ([1.0], [1.0, 2.0], DIFFERENT),
        ({'a': 1.0}, {'a': 1.0, 'b': 2.0}, DIFFERENT),
    ],
)
def test_values_of_json_are_compared_by_their_type(
    recorded: object, repeated: object, state: str
) -> None:
    comparison = Comparison()
    comparison.add_nested('', {'value': recorded}, {'value': repeated})
    assert comparison.state(same_environment=False) == state


@pytest.mark.parametrize('content', [b'{', b'\xff', b'{"a": NaN}'])
def test_a_file_that_is_no_json_is_named(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / 'summary.json'
    file.write_bytes(content)
    with pytest.raises(DdctError) as error:
        recorded_json(file)
    assert error.value.place == str(file)


@pytest.mark.parametrize(
    'place', [{'signal': 'peak_jerk_over_least'}, {'key': 'figures.peak_jerk_over_least'}]
)
def test_the_ratio_that_a_convex_program_gives_has_a_wider_bound(place):
    for change, state in ((1e-8, SAME_WITHIN), (1e-5, DIFFERENT)):
        comparison = Comparison()
        comparison.add(place, 2.0, 2.0 + 2.0 * change)
        assert comparison.state(same_environment=False) == state
        assert comparison.state(same_environment=True) == DIFFERENT
    other = Comparison()
    other.add({'key': 'figures.peak_jerk_m_s3'}, 2.0, 2.0 + 2e-8)
    assert other.state(same_environment=False) == DIFFERENT


def test_an_entry_with_the_name_of_that_ratio_has_the_wider_bound_and_the_next_entry_has_not():
    for name, state in (('peak_jerk_over_least', SAME_WITHIN), ('peak_jerk_m_s3', DIFFERENT)):
        comparison = Comparison()
        first, second = (
            {'quantities': [{'name': name, 'p5': 2.0 + more}]} for more in (0.0, 2e-8)
        )
        comparison.add_nested('', first, second)
        assert comparison.state(same_environment=False) == state
