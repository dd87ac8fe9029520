# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Capacities of both clutches and cuts of the demand that a floor covers."""

import numpy as np
import pytest
from made_run import RAD_S_PER_RPM, made_run
from shift_cases import settings_of

from ddct_bringup.floor.dynamics.capacity import COOLER_K, WARMER_K, capacity_range
from ddct_bringup.floor.dynamics.off_going import off_going_of
from ddct_bringup.floor.dynamics.torque_cut import cuts_as_usual
from ddct_controllers.handover.interface import CUT_FADE_RAD_S
from ddct_plant.models.clutch import FrictionClutch

KISS = 'friction.kiss_torque_n_m=4'
DRIFTING = (
    *(KISS, 'friction.kiss_drift_n_m_k=0.05'),
    *('friction.temperature_c=[]', 'friction.temperature_share=[]'),
)


@pytest.mark.parametrize('drift', [-0.05, 0.05])
def test_the_interval_of_the_capacity_is_that_of_all_temperatures_covered(drift):
    overrides = (KISS, f'friction.kiss_drift_n_m_k={drift}')
    settings = settings_of('launch', overrides, wear_gain=0.8)
    clutch = FrictionClutch(settings.scenario.friction, 0.8)
    temperatures = np.linspace(60.0 - COOLER_K, 60.0 + WARMER_K, 5)
    rests = [clutch.capacity([100.0], each).kinetic[0] - 80.0 for each in temperatures]
    found = capacity_range(settings, 60.0)
    assert (found.low, found.high) == pytest.approx((min(rests), max(rests)), rel=1e-9)


@pytest.mark.parametrize(
    ('overrides', 'strongest_c'),
    [((), 270.0 - COOLER_K), (DRIFTING, 270.0 + WARMER_K)],
    ids=['fading', 'drifting'],
)
def test_the_off_going_clutch_may_be_as_strong_as_at_any_temperature_covered(
    overrides, strongest_c
):
    settings = settings_of('upshift', overrides)
    step, steps = 5, 60
    nodes = 10.0 * np.arange(step, steps)[:, np.newaxis] + np.arange(11.0)
    actuator = np.zeros((steps + 1, 11))
    actuator[step:-1] = np.where(nodes < 300.0, 30.0 - nodes / 10.0, 0.0)
    run = made_run(
        np.zeros(steps + 1),
        off_going_torque_request=np.zeros(steps + 1),
        off_going_clutch_temperature=np.full(steps + 1, 270.0),
        off_going_actuator_torque=actuator,
        driveshaft_position=np.zeros(steps + 1),
        load_torque=np.zeros(steps + 1),
        holding_torque=np.zeros(steps + 1),
        clutch_torque=np.zeros((steps + 1, 11)),
    )
    clutch = FrictionClutch(settings.scenario.friction, settings.case.off_going_wear_gain)
    static = np.array([clutch.capacity(each, strongest_c).static for each in actuator[step:]])
    impulse = 0.001 * (static.sum() - (static[:, 0] + static[:, -1]).sum() / 2.0)
    assert off_going_of(settings, run, step, 0).impulse == pytest.approx(impulse, rel=1e-9)


def test_a_covered_cut_is_at_most_that_of_the_scenario_and_fades_with_the_slip():
    slip = np.array([60.0, CUT_FADE_RAD_S, CUT_FADE_RAD_S / 2.0, 0.0, -1.0])
    usual = np.array([40.0, 40.0, 20.0, 0.0, 0.0])

    def covered(cut, overrides=()):
        settings = settings_of('upshift', ('shift.torque_cut_n_m=40', *overrides))
        return cuts_as_usual(settings, made_run(slip / RAD_S_PER_RPM, torque_cut=cut))

    assert covered(usual)
    for more in np.eye(5):
        assert not covered(usual + 0.1 * more)
    assert not covered(usual - [0.0, 0.0, 0.0, 0.1, 0.0])
    # With sensors it fades with the measured slip.
    assert covered(np.full(5, 40.0), ('sensors={}',))
    assert not covered(np.full(5, 40.1), ('sensors={}',))
