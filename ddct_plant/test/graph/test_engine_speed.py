# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A commanded engine with limits is limited by them at w_m, the first of the four speeds."""

from types import SimpleNamespace
from typing import Any

import pytest

pytest.importorskip('rclpy')

from ddct_plant.base.timebase import stamp_of_step  # noqa: E402
from ddct_plant.nodes.engine_node import EngineNode  # noqa: E402
from ddct_plant.signals.topics import JOINT_STATES

MESSAGE = JOINT_STATES.message(stamp_of_step(3), [0.0] * 4, [104.72, 16.0, 1.0, 0.5], [0.0] * 4)


@pytest.mark.parametrize(('limits', 'expected'), [(object(), 104.72), (None, 0.0)])
def test_the_speed_that_counts_is_that_of_the_engine(limits, expected):
    node: Any = SimpleNamespace(
        settings=SimpleNamespace(scenario=SimpleNamespace(engine_limits=limits))
    )
    assert EngineNode._speed(node, MESSAGE) == expected
