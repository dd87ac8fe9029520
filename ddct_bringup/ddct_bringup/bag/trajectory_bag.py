"""Write a trajectory as the bag that the graph's recorder would have left of the same run."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from rclpy.serialization import serialize_message

from ddct_bringup.bag.run_info_order import run_info_order
from ddct_bringup.bag.topics import recorded_topics
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.bag.writer import BagWriter
from ddct_plant.base.timebase import START_NS, stamp_of_step
from ddct_plant.graph import messages

RunInfo = Mapping[str, Sequence[tuple[str, str]]]
"""Per node name the (key, value) pairs that it latches on `run_info`."""

CONTROLLER_NODE = 'controller'
"""Whose name `controller/status` carries."""


def write_trajectory(
    trajectory: Trajectory,
    folder: Path,
    name: str,
    custom_data: Mapping[str, str],
    run_info: RunInfo,
) -> Path:
    """
    Write `<folder>/<name>_0.mcap` and `metadata.yaml`, and return the path of the former.

    Raise DdctError when the bag cannot be written.
    """
    two_input = trajectory.engine_torque_request is not None
    topics = recorded_topics(lockstep=True, two_input=two_input)
    with BagWriter(folder, name, topics, custom_data) as bag:
        for node in run_info_order(run_info):
            message = messages.status_message(START_NS, node, run_info[node])
            bag.write('run_info', START_NS, serialize_message(message))
        order = [topic.name for topic in topics if topic.every_tick]
        for stamp, tick in _ticks(trajectory):
            for topic in order:
                bag.write(topic, stamp, serialize_message(tick[topic]))
    return bag.path


def _ticks(trajectory: Trajectory) -> Iterator[tuple[int, dict[str, Any]]]:
    """Yield the stamp in ns and the message of every topic, tick by tick."""
    actuator, clutch = messages.TorquePointsMessage(), messages.TorquePointsMessage()
    reference = messages.SlipReferenceMessage(trajectory.slip_reference.shape[1] - 1)
    for k in range(trajectory.steps + 1):
        stamp = stamp_of_step(k)
        tick = {
            '/clock': messages.clock_message(stamp),
            'driveline/joint_states': messages.joint_states_message(
                stamp,
                trajectory.joint_position[k],
                trajectory.joint_speed[k],
                trajectory.joint_effort[k],
            ),
            'clutch/slip': messages.slip_message(stamp, trajectory.slip_speed[k]),
            'vehicle/twist': messages.twist_message(stamp, trajectory.vehicle_speed[k]),
            'vehicle/accel': messages.accel_message(stamp, trajectory.vehicle_accel[k]),
            'engine/torque_demand': messages.torque_message(stamp, trajectory.torque_demand[k]),
            'engine/torque': messages.torque_message(stamp, trajectory.engine_torque[k]),
            'load/torque': messages.torque_message(stamp, trajectory.load_torque[k]),
            'clutch/slip_reference': reference.fill(
                stamp, trajectory.slip_reference[k], trajectory.slip_reference_rate[k]
            ),
            'controller/status': messages.status_message(
                stamp, CONTROLLER_NODE, trajectory.status[k]
            ),
            'clutch/torque_request': messages.torque_message(stamp, trajectory.torque_request[k]),
            'actuator/torque': actuator.fill(stamp, trajectory.actuator_torque[k]),
            'clutch/torque': clutch.fill(stamp, trajectory.clutch_torque[k]),
            'recorder/ack': messages.ack_message(stamp),
        }
        if trajectory.engine_torque_request is not None:
            tick['engine/torque_request'] = messages.torque_message(
                stamp, trajectory.engine_torque_request[k]
            )
        yield stamp, tick
