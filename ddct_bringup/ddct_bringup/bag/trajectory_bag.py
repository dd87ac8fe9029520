"""Write a trajectory as the bag that the graph's recorder would have left of the same run."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from ddct_bringup.bag.file.plain_message import plain_class, serialiser
from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.bag.run_info import run_info_order
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.bag.writer import BagWriter
from ddct_plant.base.timebase import START_NS, stamp_of_step
from ddct_plant.graph.topics import RUN_INFO, recorded_topics

RunInfo = Mapping[str, Sequence[tuple[str, str]]]
"""Per node name the (key, value) pairs that it latches on `run_info`."""


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
    run = RunFacts.from_custom_data(custom_data).kind(
        two_input=trajectory.two_input, sensed=trajectory.sensed
    )
    topics = recorded_topics(run)
    with BagWriter(folder, name, topics, custom_data) as bag:
        write_info, serialise_info = RUN_INFO.writer(plain_class), serialiser(RUN_INFO.type)
        for node in run_info_order(run_info):
            message = write_info(START_NS, run_info[node], name=node)
            bag.write(RUN_INFO.name, START_NS, serialise_info(message))
        writers = [
            (topic, topic.writer(plain_class), serialiser(topic.type), topic.signals_in(run))
            for topic in topics
            if topic.every_tick
        ]
        for k in range(trajectory.steps + 1):
            stamp = stamp_of_step(k)
            for topic, write, serialise, signals in writers:
                values = (trajectory.signals[signal.name][k] for signal in signals)
                bag.write(topic.name, stamp, serialise(write(stamp, *values)))
    return bag.path
