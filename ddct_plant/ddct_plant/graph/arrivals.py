"""Read messages off the wire with checks, so that a bad value never enters the loop."""

import math
from collections.abc import Sequence
from typing import Any

from ddct_plant.base.checks import require_finite
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import SUBSTEPS
from ddct_plant.graph.message_values import (
    JOINTS,
    slip_of,
    slip_reference_of,
    torque_of,
    torque_points_of,
    vehicle_speed_of,
)


def read_stamp_only(_topic: str, _message: Any) -> None:
    """Read no value: the message only says that its stamp has come."""


def read_torque(topic: str, message: Any) -> float:
    """Return the torque in N m of a WrenchStamped; raise DdctError unless finite."""
    return require_finite(topic, torque_of(message))


def read_torque_points(topic: str, message: Any) -> list[float]:
    """Return the (11,) torques in N m over the coming period; raise DdctError unless finite."""
    try:
        torques = torque_points_of(message)
    except IndexError:
        torques = []
    if len(torques) != SUBSTEPS + 1:
        raise DdctError(
            f'{topic} has {len(message.points)} points: it needs {SUBSTEPS + 1}, '
            '1 ms apart, each with an effort'
        )
    return _finite(topic, torques)


def read_slip(topic: str, message: Any) -> float:
    """Return the slip speed in rad/s; raise DdctError unless finite."""
    return require_finite(topic, slip_of(message))


def read_vehicle_speed(topic: str, message: Any) -> float:
    """Return the vehicle speed in m/s; raise DdctError unless finite."""
    return require_finite(topic, vehicle_speed_of(message))


def read_joint_speeds(topic: str, message: Any) -> tuple[float, float, float]:
    """Return w_m, w_p and w_r in rad/s; raise DdctError unless present and finite."""
    if list(message.name) != list(JOINTS) or len(message.velocity) != len(JOINTS):
        raise DdctError(
            f'{topic} names {list(message.name)} with {len(message.velocity)} velocities: '
            f'it needs one velocity for each of {list(JOINTS)}, in this order'
        )
    engine, shaft, wheel, _ = _finite(topic, message.velocity)
    return engine, shaft, wheel


def read_slip_reference(
    topic: str, message: Any, preview_steps: int
) -> tuple[list[float], list[float]]:
    """
    Return the reference in rad/s and its rate in rad/s^2, (preview_steps + 1,) each.

    Raise DdctError for a value that is not finite or a preview that is too short.
    """
    if len(message.points) <= preview_steps:
        raise DdctError(
            f'{topic} has {len(message.points)} points and the controller needs '
            f'{preview_steps + 1}: start the reference with '
            f'--ros-args -p preview_steps:={preview_steps}'
        )
    if not all(point.velocities and point.accelerations for point in message.points):
        raise DdctError(f'{topic}: each point needs a velocity and an acceleration')
    speeds, rates = slip_reference_of(message)
    last = preview_steps + 1
    return _finite(topic, speeds[:last]), _finite(topic, rates[:last])


def _finite(topic: str, values: Sequence[float]) -> list[float]:
    if not all(map(math.isfinite, values)):
        for value in values:
            require_finite(topic, value)
    return list(values)
