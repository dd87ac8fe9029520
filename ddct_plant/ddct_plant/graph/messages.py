"""
Make the graph's messages, one function per kind, all SI; `message_values` reads them.

Building a message costs 1 to 60 us, filling one far below 1 us, so a publisher may keep one
message of its kind and hand it in as `reuse` (or keep a `TorquePointsMessage`, a
`SlipReferenceMessage` or a `StatusMessage`); what comes back is then that same object.
"""

from array import array
from collections.abc import Sequence

from builtin_interfaces.msg import Duration, Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import AccelStamped, TwistStamped, WrenchStamped
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Header
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from ddct_plant.base.timebase import PERIOD_NS, SUBSTEP_NS, SUBSTEPS
from ddct_plant.graph.message_values import (
    CLUTCH_JOINT,
    JOINTS,
    NS_PER_S,
    SLIP_JOINT,
    slip_of,
    slip_reference_of,
    stamp_ns,
    status_name_of,
    status_pairs_of,
    torque_of,
    torque_points_of,
    vehicle_accel_of,
    vehicle_speed_of,
)

__all__ = [
    'JOINTS',
    'SlipReferenceMessage',
    'StatusMessage',
    'TorquePointsMessage',
    'accel_message',
    'ack_message',
    'clock_message',
    'joint_states_message',
    'slip_message',
    'slip_of',
    'slip_reference_message',
    'slip_reference_of',
    'stamp_message',
    'stamp_ns',
    'status_message',
    'status_name_of',
    'status_pairs_of',
    'torque_message',
    'torque_of',
    'torque_points_message',
    'torque_points_of',
    'twist_message',
    'vehicle_accel_of',
    'vehicle_speed_of',
]


def stamp_message(stamp: int) -> Time:
    """Return the stamp in ns as a Time."""
    time = Time()
    _set_time(time, stamp)
    return time


def clock_message(stamp: int, *, reuse: Clock | None = None) -> Clock:
    """Return `/clock` at a stamp in ns."""
    message = reuse or Clock()
    _set_time(message.clock, stamp)
    return message


def ack_message(stamp: int, *, reuse: Header | None = None) -> Header:
    """Return `recorder/ack` of the tick with this stamp in ns."""
    message = reuse or Header()
    _set_time(message.stamp, stamp)
    return message


def joint_states_message(
    stamp: int,
    positions: Sequence[float],
    speeds: Sequence[float],
    efforts: Sequence[float],
    *,
    reuse: JointState | None = None,
) -> JointState:
    """Return `driveline/joint_states`, (4,) rad, rad/s and N m in the order of JOINTS."""
    message = reuse or JointState(name=list(JOINTS))
    _set_time(message.header.stamp, stamp)
    message.position = array('d', positions)
    message.velocity = array('d', speeds)
    message.effort = array('d', efforts)
    return message


def slip_message(
    stamp: int, slip_speed: float, *, reuse: TwistStamped | None = None
) -> TwistStamped:
    """Return `clutch/slip` in rad/s."""
    message = reuse or TwistStamped()
    _set_time(message.header.stamp, stamp)
    message.twist.angular.x = slip_speed
    return message


def twist_message(stamp: int, speed: float, *, reuse: TwistStamped | None = None) -> TwistStamped:
    """Return `vehicle/twist` in m/s."""
    message = reuse or TwistStamped()
    _set_time(message.header.stamp, stamp)
    message.twist.linear.x = speed
    return message


def accel_message(
    stamp: int, acceleration: float, *, reuse: AccelStamped | None = None
) -> AccelStamped:
    """Return `vehicle/accel` in m/s^2."""
    message = reuse or AccelStamped()
    _set_time(message.header.stamp, stamp)
    message.accel.linear.x = acceleration
    return message


def torque_message(
    stamp: int, torque: float, *, reuse: WrenchStamped | None = None
) -> WrenchStamped:
    """Return a topic that carries one torque in N m: engine, load or a request."""
    message = reuse or WrenchStamped()
    _set_time(message.header.stamp, stamp)
    message.wrench.torque.x = torque
    return message


class TorquePointsMessage:
    """One `actuator/torque` or `clutch/torque`, to be filled at every tick."""

    def __init__(self) -> None:
        points = [_point(i * SUBSTEP_NS, effort=[0.0]) for i in range(SUBSTEPS + 1)]
        self._message = JointTrajectory(joint_names=[CLUTCH_JOINT], points=points)
        self._efforts = [point.effort for point in points]

    def fill(self, stamp: int, torques: Sequence[float]) -> JointTrajectory:
        """Return the (11,) torques in N m, 1 ms apart; raise ValueError if not 11."""
        _set_time(self._message.header.stamp, stamp)
        for effort, torque in zip(self._efforts, torques, strict=True):
            effort[0] = torque
        return self._message


def torque_points_message(stamp: int, torques: Sequence[float]) -> JointTrajectory:
    """Return a new `actuator/torque` or `clutch/torque`; see `TorquePointsMessage.fill`."""
    return TorquePointsMessage().fill(stamp, torques)


class SlipReferenceMessage:
    """One `clutch/slip_reference`, now and `preview_steps` ahead, to be filled at every tick."""

    def __init__(self, preview_steps: int) -> None:
        points = [
            _point(i * PERIOD_NS, velocities=[0.0], accelerations=[0.0])
            for i in range(preview_steps + 1)
        ]
        self._message = JointTrajectory(joint_names=[SLIP_JOINT], points=points)
        self._values = [(point.velocities, point.accelerations) for point in points]

    def fill(self, stamp: int, speeds: Sequence[float], rates: Sequence[float]) -> JointTrajectory:
        """Return (P + 1,) rad/s and rad/s^2, 10 ms apart; raise ValueError for other lengths."""
        _set_time(self._message.header.stamp, stamp)
        for (velocity, acceleration), speed, rate in zip(self._values, speeds, rates, strict=True):
            velocity[0] = speed
            acceleration[0] = rate
        return self._message


def slip_reference_message(
    stamp: int, speeds: Sequence[float], rates: Sequence[float]
) -> JointTrajectory:
    """Return a new `clutch/slip_reference`; see `SlipReferenceMessage.fill`."""
    return SlipReferenceMessage(len(speeds) - 1).fill(stamp, speeds, rates)


class StatusMessage:
    """One DiagnosticArray with one status, to be filled at every tick."""

    def __init__(self, name: str) -> None:
        """Take who the status is about."""
        self._status = DiagnosticStatus(name=name)
        self._message = DiagnosticArray(status=[self._status])
        self._values: list[KeyValue] = []

    def fill(self, stamp: int, pairs: Sequence[tuple[str, str]]) -> DiagnosticArray:
        """Return the (key, value) pairs, of which there may be more or fewer than last time."""
        _set_time(self._message.header.stamp, stamp)
        if len(self._values) != len(pairs):
            self._values = [KeyValue() for _ in pairs]
            self._status.values = self._values
        for value, (key, text) in zip(self._values, pairs, strict=True):
            value.key = key
            value.value = text
        return self._message


def status_message(stamp: int, name: str, pairs: Sequence[tuple[str, str]]) -> DiagnosticArray:
    """Return a new DiagnosticArray with one status; see `StatusMessage.fill`."""
    return StatusMessage(name).fill(stamp, pairs)


def _set_time(time: Time | Duration, time_ns: int) -> None:
    time.sec, time.nanosec = divmod(time_ns, NS_PER_S)


def _point(time_ns: int, **arrays: list[float]) -> JointTrajectoryPoint:
    point = JointTrajectoryPoint(**arrays)
    _set_time(point.time_from_start, time_ns)
    return point
