# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The weight of torque rates in the feedforward is the best one for the car's acceleration."""

from unittest.mock import patch

import pytest

from ddct_bringup.metrics.values import compute_metrics
from ddct_bringup.run.headless import run_headless
from ddct_controllers.design import feedforward
from ddct_controllers.design.feedforward import TORQUE_RATE_WEIGHT, design_feedforward
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SCENARIO = load_scenario('thesis')


class NoFeedback(Controller):
    def reset(self) -> None:
        pass

    def update(self, measurement: Measurement) -> Command:
        return Command(0.0)


def acceleration_std(weight: float) -> float:
    """Return the standard deviation of A_x in m/s^2 without feedback."""
    model = design_feedforward(SCENARIO.driveline, SCENARIO.actuator, torque_rate_weight=weight)
    with patch.object(feedforward, 'design_feedforward', lambda *_: model):
        trajectory = run_headless(
            RunSettings(KnownSettings(SCENARIO, 'feedforward')), NoFeedback()
        )
    found = compute_metrics(
        trajectory,
        control_start_s=SCENARIO.control_start_s,
        score_window_s=SCENARIO.score_window_s,
    )['acceleration_std_m_s2']
    assert found is not None
    return found


@pytest.mark.parametrize('weight', [0.01, 0.02, 0.06, 0.1])
def test_the_weight_that_we_take_has_the_lowest_std_of_the_acceleration(weight: float) -> None:
    assert acceleration_std(TORQUE_RATE_WEIGHT) < acceleration_std(weight)
