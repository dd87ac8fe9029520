# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Sensor options for test runs, each option in use."""

ALL_ON = (
    'sensors={engine_speed: {noise_rad_s: 0.2, quantum_rad_s: 0.1, delay_s: 0.02, dropout: 0.1, '
    'gain: 1.001, bias_rad_s: -0.1}, '
    'shaft_speed: {noise_rad_s: 0.1, teeth: 600, count_s: 0.02, dropout: 0.2, dropout_burst: 3}, '
    'wheel_speed: {noise_rad_s: 0.01, teeth: 4000, quantum_rad_s: 0.01, delay_s: 0.01}, '
    'vehicle_speed: {noise_m_s: 0.05, quantum_m_s: 0.02, delay_s: 0.03, dropout: 0.1, '
    'gain: 0.98, bias_m_s: 0.1}, '
    'engine_torque: {noise_n_m: 3.0, quantum_n_m: 1.0, delay_s: 0.01, dropout: 0.1, '
    'dropout_burst: 2, gain: 1.05, bias_n_m: 2.0}}'
)
"""Change of a scenario that turns every option on."""
FLAGS = (
    'sensed_joint_held',
    'sensed_slip_held',
    'sensed_vehicle_held',
    'sensed_torque_held',
)
