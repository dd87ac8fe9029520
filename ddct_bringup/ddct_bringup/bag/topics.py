"""The one table of recorded topics, in the order in which a tick is written."""

from dataclasses import dataclass


@dataclass(frozen=True)
class TopicSpec:
    """One recorded topic."""

    name: str
    """As nodes name it: relative, except `/clock` and `/diagnostics`."""
    type: str
    """Such as 'sensor_msgs/msg/JointState'."""
    every_tick: bool = True
    """Whether a lock-step recording holds it exactly once per tick."""
    latched: bool = False
    """Whether it is transient local, depth 1."""
    two_input_only: bool = False
    """Whether only controllers that also ask for engine torque have it."""
    realtime_only: bool = False
    """Whether it carries wall-clock figures, which a lock-step recording must not hold."""

    @property
    def resolved_name(self) -> str:
        """The name in the bag, with its leading slash."""
        return resolved_name(self.name)


def resolved_name(topic: str) -> str:
    """Return a topic's name as the bag has it, outside any namespace."""
    return topic if topic.startswith('/') else f'/{topic}'


TOPICS = (
    TopicSpec('run_info', 'diagnostic_msgs/msg/DiagnosticArray', every_tick=False, latched=True),
    TopicSpec('/clock', 'rosgraph_msgs/msg/Clock'),
    TopicSpec('driveline/joint_states', 'sensor_msgs/msg/JointState'),
    TopicSpec('clutch/slip', 'geometry_msgs/msg/TwistStamped'),
    TopicSpec('vehicle/twist', 'geometry_msgs/msg/TwistStamped'),
    TopicSpec('vehicle/accel', 'geometry_msgs/msg/AccelStamped'),
    TopicSpec('engine/torque_demand', 'geometry_msgs/msg/WrenchStamped'),
    TopicSpec('engine/torque', 'geometry_msgs/msg/WrenchStamped'),
    TopicSpec('load/torque', 'geometry_msgs/msg/WrenchStamped'),
    TopicSpec('clutch/slip_reference', 'trajectory_msgs/msg/JointTrajectory'),
    TopicSpec('controller/status', 'diagnostic_msgs/msg/DiagnosticArray'),
    TopicSpec('clutch/torque_request', 'geometry_msgs/msg/WrenchStamped'),
    TopicSpec('engine/torque_request', 'geometry_msgs/msg/WrenchStamped', two_input_only=True),
    TopicSpec('actuator/torque', 'trajectory_msgs/msg/JointTrajectory'),
    TopicSpec('clutch/torque', 'trajectory_msgs/msg/JointTrajectory'),
    TopicSpec('recorder/ack', 'std_msgs/msg/Header'),
    TopicSpec(
        'controller/timing',
        'diagnostic_msgs/msg/DiagnosticArray',
        every_tick=False,
        realtime_only=True,
    ),
    TopicSpec(
        '/diagnostics',
        'diagnostic_msgs/msg/DiagnosticArray',
        every_tick=False,
        realtime_only=True,
    ),
)
"""`run_info` comes first, at t_0; then the topics of each tick, `recorder/ack` last."""


def recorded_topics(*, lockstep: bool, two_input: bool = False) -> tuple[TopicSpec, ...]:
    """Return the topics that a run records, in writing order."""
    return tuple(
        topic
        for topic in TOPICS
        if (two_input or not topic.two_input_only) and not (lockstep and topic.realtime_only)
    )
