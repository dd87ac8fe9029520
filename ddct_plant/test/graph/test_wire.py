# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nodes send the bytes that rclpy would send, and read from bytes what rclpy would read."""

from typing import Any

import pytest
from refusals import refused

pytest.importorskip('trajectory_msgs.msg', reason='needs the ROS message types')

from rclpy.serialization import deserialize_message, serialize_message  # noqa: E402

from ddct_plant.bag_file.cdr import CdrNormaliser  # noqa: E402
from ddct_plant.bag_file.message_definitions import load_definition  # noqa: E402
from ddct_plant.base.errors import DdctError  # noqa: E402
from ddct_plant.base.timebase import stamp_of_step  # noqa: E402
from ddct_plant.graph.wire import decoder, serialiser  # noqa: E402
from ddct_plant.signals import topics  # noqa: E402
from ddct_plant.signals.topic import Topic  # noqa: E402

TORQUES = [float(i) / 3.0 for i in range(11)]
CAPACITIES = [1.0 + torque for torque in TORQUES]
PAIRS = [('a', '1.5'), ('key', '')]
VALUES: dict[str, Any] = {
    'driveline/joint_states': ([0.1, 0.2, 0.3, 0.4], [1.1, 1.2, 1.3, 1.4], [2.1, 2.2, 2.3, 2.4]),
    'sensors/joint_states': ([1.1, 1.2, 1.3],),
    'sensors/status': ([0.0, 1.0, 0.0], 0.0, 1.0),
    'clutch/slip_reference': ([1.0, 1.1, 1.2], [2.0, 2.1, 2.2]),
    'actuator/torque': (TORQUES,),
    'clutch/torque': (TORQUES, CAPACITIES),
    'clutch/phase': (1.0, 0.5, ()),
    'off_going/clutch/phase': (1.0, 0.5, 0.25, ()),
    **dict.fromkeys(('run_info', 'controller/status', 'controller/timing'), (PAIRS,)),
    '/diagnostics': (PAIRS,),
}
"""Values of a topic; others have numbers from 1 up, one for each signal."""
CHECKED = [topic for topic in topics.TOPICS if topic.every_tick]


def _values(topic: Topic) -> Any:
    same = VALUES.get(
        topic.name.removeprefix('off_going/'), [1.0 + i for i in range(len(topic.signals))]
    )
    return VALUES.get(topic.name, same)


def _changed(values: Any) -> Any:
    """Return other values of the same lengths; texts and flags stay."""
    if isinstance(values, float):
        return values + 0.25 if values > 1.0 else values
    return type(values)(_changed(each) for each in values) if values not in ((), PAIRS) else values


@pytest.mark.parametrize('topic', CHECKED, ids=lambda topic: topic.name)
def test_a_message_has_the_bytes_that_rclpy_gives_it(topic: Topic) -> None:
    serialise = serialiser(topic)
    normalise = CdrNormaliser(load_definition(topic.type)).normalise
    first = _values(topic)
    for step, values in enumerate([first, _changed(first), first]):
        message = topic.message(stamp_of_step(step), *values)
        sent = serialise(stamp_of_step(step), *values)
        assert normalise(sent) == normalise(serialize_message(message))
        assert repr(deserialize_message(sent, topic.message_class)) == repr(message)


@pytest.mark.parametrize('topic', CHECKED, ids=lambda topic: topic.name)
def test_bytes_are_read_as_the_message_of_rclpy(topic: Topic) -> None:
    message = topic.message(stamp_of_step(7), *_values(topic))
    options: dict[str, Any] = {'joints': 2} if topic.name.endswith('clutch/torque') else {}
    decoded = decoder(topic)(serialize_message(message))
    assert topic.read(decoded, **options) == topic.read(message, **options)


def test_a_message_takes_as_many_numbers_as_the_first_one() -> None:
    serialise = serialiser(topics.ACTUATOR_TORQUE)
    serialise(0, TORQUES)
    with pytest.raises(ValueError):
        serialise(0, TORQUES[:-1])


def test_another_publisher_of_the_topic_has_a_length_of_its_own() -> None:
    """As in one process the controllers of two runs with other previews, one after the other."""
    for points in (3, 1):
        numbers = [0.5] * points
        sent = serialiser(topics.SLIP_REFERENCE)(0, numbers, numbers)
        message = decoder(topics.SLIP_REFERENCE)(sent)
        read = topics.SLIP_REFERENCE.read(message, preview_steps=points - 1)
        assert [list(each) for each in read] == [numbers, numbers]


@pytest.mark.parametrize(
    'spoil', [lambda cdr: cdr[:-9], lambda cdr: b'\0\0' + cdr[2:], lambda _: b'']
)
def test_bytes_of_another_form_are_refused(spoil: Any) -> None:
    cdr = serialiser(topics.TORQUE_REQUEST)(0, 1.0)
    with refused(DdctError, 'geometry_msgs/msg/WrenchStamped'):
        decoder(topics.TORQUE_REQUEST)(spoil(cdr))


def test_a_text_that_is_none_is_refused() -> None:
    topic = topics.CONTROLLER_STATUS
    cdr = serialiser(topic)(0, [('key', 'value')])
    with pytest.raises(UnicodeDecodeError):
        decoder(topic)(cdr.replace(b'value', b'\xff\xfe\xff\xfe\xff'))
