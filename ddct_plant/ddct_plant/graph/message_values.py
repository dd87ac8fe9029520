"""
Read the values that the graph's messages carry, all SI; imports nothing of ROS.

Every function only uses attributes, so it serves rclpy's messages and messages decoded from a bag.
"""

from typing import Any

JOINTS = ('engine', 'primary_shaft', 'wheel', 'driveshaft')
"""Order of the joints in `driveline/joint_states`."""
CLUTCH_JOINT = 'clutch'
SLIP_JOINT = 'clutch_slip'

NS_PER_S = 1_000_000_000

SAFE_STATE = ': safe state'
"""Ends the name of the status by which a node says that it is in its safe state."""
SINCE = 'since_ns'
"""Key of the stamp since when."""


def stamp_ns(message: Any) -> int:
    """Return the stamp in ns of a message with a header, of a Header, of a Clock or of a Time."""
    header = getattr(message, 'header', message)
    time = getattr(header, 'stamp', None) or getattr(message, 'clock', message)
    return time.sec * NS_PER_S + time.nanosec


def slip_of(message: Any) -> float:
    """Return the slip speed in rad/s of `clutch/slip`."""
    return message.twist.angular.x


def vehicle_speed_of(message: Any) -> float:
    """Return the speed in m/s of `vehicle/twist`."""
    return message.twist.linear.x


def vehicle_accel_of(message: Any) -> float:
    """Return the acceleration in m/s^2 of `vehicle/accel`."""
    return message.accel.linear.x


def torque_of(message: Any) -> float:
    """Return the torque in N m of a topic that carries one torque."""
    return message.wrench.torque.x


def torque_points_of(message: Any) -> list[float]:
    """Return the (11,) torques in N m of `actuator/torque` or `clutch/torque`."""
    return [point.effort[0] for point in message.points]


def slip_reference_of(message: Any) -> tuple[list[float], list[float]]:
    """Return the (P + 1,) rad/s and (P + 1,) rad/s^2 of `clutch/slip_reference`."""
    speeds = [point.velocities[0] for point in message.points]
    rates = [point.accelerations[0] for point in message.points]
    return speeds, rates


def status_name_of(message: Any) -> str:
    """Return who the one status of a message is about."""
    return message.status[0].name


def status_pairs_of(message: Any) -> tuple[tuple[str, str], ...]:
    """Return the (key, value) pairs of the one status of a message."""
    return tuple((pair.key, pair.value) for pair in message.status[0].values)
