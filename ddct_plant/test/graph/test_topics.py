# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The order of signals in a run's hash and tables, and their names there."""

import pytest

from ddct_plant.signals.topic import Signal
from ddct_plant.signals.topics import all_signals


def test_signals_are_numbers_then_text_then_what_only_some_runs_have():
    assert [signal.name for signal in all_signals()] == [
        'joint_position',
        'joint_speed',
        'joint_effort',
        'slip_speed',
        'vehicle_speed',
        'vehicle_accel',
        'torque_demand',
        'engine_torque',
        'load_torque',
        'slip_reference',
        'slip_reference_rate',
        'torque_request',
        'open_loop_torque',
        'closed_loop_torque',
        'closing_torque',
        'actuator_torque',
        'clutch_torque',
        'status',
        'off_going_shaft_angle',
        'off_going_shaft_speed',
        'off_going_transmitted_torque',
        'off_going_slip_speed',
        'clutch_phase',
        'friction_work',
        'off_going_clutch_phase',
        'off_going_friction_work',
        'tie_up_work',
        'sensed_joint_speed',
        'sensed_slip_speed',
        'sensed_vehicle_speed',
        'sensed_joint_held',
        'sensed_slip_held',
        'sensed_vehicle_held',
        'handover_share',
        'on_coming_wear_deviation',
        'on_coming_torque_offset',
        'off_going_torque_request',
        'torque_cut',
        'sensed_engine_torque',
        'sensed_torque_held',
        'holding_torque',
        'engine_torque_request',
        'off_going_actuator_torque',
        'clutch_static_torque',
        'off_going_clutch_torque',
        'off_going_clutch_static_torque',
        'clutch_temperature',
        'off_going_clutch_temperature',
        'phase_events',
        'off_going_phase_events',
    ]


@pytest.mark.parametrize(
    ('unit', 'column'),
    [('rad', 'x_rad'), ('rad/s^2', 'x_rad_s2'), ('N m', 'x_n_m'), ('m/s', 'x_m_s')],
)
def test_a_column_is_called_by_the_signal_and_its_unit(unit, column):
    assert Signal('x', unit, '').column == column
