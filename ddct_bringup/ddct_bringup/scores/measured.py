"""What a log of another tool does not have the signals for, by the figures that need them."""

from collections.abc import Mapping
from typing import Any

from ddct_bringup.bag.measured_run import TORSION
from ddct_bringup.bag.reader import Recording

NOT_COMPUTED = 'not_computed'
"""Key of `scores.json`, of such a log alone: reasons by figure."""
NEEDS: Mapping[str, tuple[str, ...]] = {
    TORSION: ('torsion_speed_std_rpm', 'judder', 'shuffle_amplitude', 'shuffle_decay'),
    'vehicle_accel': (
        'acceleration_std_m_s2',
        'peak_jerk_m_s3',
        'vdv_m_s1_75',
        'weighted_acceleration_m_s2',
        'peak_jerk',
        'mean_jerk',
        'peak_acceleration',
        'weighted_acceleration',
        'daily_vibration_dose',
    ),
    'slip_reference': ('slip_rmse_rpm',),
    'clutch_torque': ('friction_energy_j', 'friction_energy'),
    'torque_request': ('torque_total_variation_n_m', 'request_variation'),
    'driveshaft_torque': ('torque_dip',),
}
"""Metrics and criteria by the quantity without which they do not exist."""


def not_computed(
    recording: Recording, metrics: Mapping[str, Any], verdict: Mapping[str, Any]
) -> dict[str, str]:
    """Return why metrics and criteria that are null are so, where the log lacks a quantity."""
    values = {each['name']: each['value'] for each in verdict['criteria']} | dict(metrics)
    return {
        name: recording.absent[quantity]
        for quantity, names in NEEDS.items()
        for name in names
        if quantity in recording.absent and values.get(name) is None
    }
