# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The controller `least_jerk`: the slip that it expects while the car stands."""

from typing import Any

import pytest

from ddct_controllers.interface import Measurement
from ddct_controllers.registry import make_controller
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings

INERTIA, DAMPING = 0.25, 0.05
"""J_m in kg m^2 and c_m in N m s/rad."""


def standing(step: int, engine_speed: float, engine_torque: float) -> Measurement:
    """Return the signals of a car that its brake holds, without a clutch torque."""
    return Measurement(step, engine_speed, 0.0, 0.0, 0.0, engine_torque, [0.0], [0.0])


@pytest.mark.parametrize(('speed', 'torque'), [(105.0, 40.0), (105.0, 5.25), (300.0, 0.0)])
def test_the_slip_in_a_standing_car_is_expected_from_the_torques_of_the_engine(speed, torque):
    """J_m dw_m/dt = C_m - c_m w_m over a period, with the speed at its end."""
    changes = {'driveline.engine_inertia': INERTIA, 'driveline.engine_damping': DAMPING}
    known = KnownSettings(load_scenario('launch', changes))
    controller: Any = make_controller('least_jerk', known)
    controller.hold(standing(0, speed, torque))
    after = (INERTIA * speed + PERIOD_S * torque) / (INERTIA + DAMPING * PERIOD_S)
    controller.hold(standing(1, after, torque))
    assert controller._slip.slip == pytest.approx(after, rel=1e-9)
