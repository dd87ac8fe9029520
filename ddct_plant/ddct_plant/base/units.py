"""Conversions between SI and the units people read; nothing else converts."""

import math
from typing import TypeVar

import numpy as np

RAD_S_PER_RPM = math.pi / 30.0
RPM_PER_RAD_S = 30.0 / math.pi


Speed = TypeVar('Speed', float, np.ndarray)


def rpm_from_rad_s(speed: Speed) -> Speed:
    """Convert a speed (float or array) from rad/s to rpm."""
    return speed * RPM_PER_RAD_S


def rad_s_from_rpm(speed_rpm: Speed) -> Speed:
    """Convert a speed (float or array) from rpm to rad/s."""
    return speed_rpm * RAD_S_PER_RPM
