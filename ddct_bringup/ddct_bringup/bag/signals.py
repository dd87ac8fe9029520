"""Which topic carries which signals of a trajectory, and how to read them off a message."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ddct_plant.base.errors import DdctError
from ddct_plant.graph.message_values import (
    JOINTS,
    slip_of,
    slip_reference_of,
    status_pairs_of,
    torque_of,
    torque_points_of,
    vehicle_accel_of,
    vehicle_speed_of,
)


@dataclass(frozen=True)
class Signal:
    """The signals of one topic."""

    topic: str
    fields: tuple[str, ...]
    """Names of the attributes of `Trajectory`."""
    values: Callable[[Any], tuple[Any, ...]]
    """Returns one value per field."""


def _joints(message: Any) -> tuple[Any, ...]:
    if tuple(message.name) != JOINTS:
        raise DdctError(f'the joints are {", ".join(message.name)}, not {", ".join(JOINTS)}')
    return message.position, message.velocity, message.effort


def _one(read: Callable[[Any], Any]) -> Callable[[Any], tuple[Any, ...]]:
    return lambda message: (read(message),)


SIGNALS = (
    Signal('driveline/joint_states', ('joint_position', 'joint_speed', 'joint_effort'), _joints),
    Signal('clutch/slip', ('slip_speed',), _one(slip_of)),
    Signal('vehicle/twist', ('vehicle_speed',), _one(vehicle_speed_of)),
    Signal('vehicle/accel', ('vehicle_accel',), _one(vehicle_accel_of)),
    Signal('engine/torque_demand', ('torque_demand',), _one(torque_of)),
    Signal('engine/torque', ('engine_torque',), _one(torque_of)),
    Signal('load/torque', ('load_torque',), _one(torque_of)),
    Signal('clutch/slip_reference', ('slip_reference', 'slip_reference_rate'), slip_reference_of),
    Signal('controller/status', ('status',), _one(status_pairs_of)),
    Signal('clutch/torque_request', ('torque_request',), _one(torque_of)),
    Signal('actuator/torque', ('actuator_torque',), _one(torque_points_of)),
    Signal('clutch/torque', ('clutch_torque',), _one(torque_points_of)),
)
"""One entry per topic, and per field of `Trajectory` exactly one topic."""

ENGINE_REQUEST = Signal('engine/torque_request', ('engine_torque_request',), _one(torque_of))
"""Recorded with two-input controllers only."""
