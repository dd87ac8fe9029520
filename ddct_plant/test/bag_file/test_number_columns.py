# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Messages that differ in stamps and numbers alone are written and read many at once."""

import numpy as np
import pytest
from mcap_ros2._dynamic import generate_dynamic

from ddct_plant.bag_file.message_definitions import decode, encode, load_definition, message_class
from ddct_plant.bag_file.number_columns import NumberColumns
from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.signals import topics
from ddct_plant.signals.message_kind import stamp_ns

STAMPS = np.array([stamp_of_step(k) for k in (0, 1, 99, 100, 4_000)])
SIZES = {'actuator/torque': 11, 'clutch/torque': 11, 'clutch/slip_reference': 3}
NUMBERS = [topic for topic in topics.TOPICS if topic.kind.numbers_alone]


def made(topic):
    """Return columns of random numbers, and the layout of the messages with them."""
    random = np.random.default_rng(7)
    size = SIZES.get(topic.name.removeprefix('off_going/'))
    columns = []
    for signal in topic.signals:
        count = size or (signal.size if signal.size != 1 else None)
        columns.append(random.normal(size=(len(STAMPS), *([count] if count else []))))
    return columns, NumberColumns(topic, [column[0] for column in columns])


@pytest.mark.parametrize('topic', NUMBERS, ids=lambda topic: topic.name)
def test_each_message_is_that_of_its_own_stamp_and_numbers(topic):
    columns, layout = made(topic)
    write = topic.writer(message_class)
    one_by_one = [
        encode(write(int(stamp), *(column[row] for column in columns)))
        for row, stamp in enumerate(STAMPS)
    ]
    assert layout.encode(STAMPS, columns) == one_by_one


@pytest.mark.parametrize('topic', NUMBERS, ids=lambda topic: topic.name)
def test_another_decoder_finds_the_same_stamps_and_numbers(topic):
    columns, layout = made(topic)
    read = generate_dynamic(topic.type, load_definition(topic.type).schema_text)[topic.type]
    for row, cdr in enumerate(layout.encode(STAMPS, columns)):
        message = read(cdr)
        assert stamp_ns(message) == STAMPS[row]
        for value, column in zip(topic.values(message), columns, strict=True):
            assert np.array_equal(value, column[row])


@pytest.mark.parametrize('topic', NUMBERS, ids=lambda topic: topic.name)
def test_stamps_and_numbers_come_back_to_the_last_bit(topic):
    columns, layout = made(topic)
    stamps, values = layout.decode(layout.encode(STAMPS, columns))
    assert stamps.tolist() == STAMPS.tolist()
    assert len(values) == len(columns)
    for value, column in zip(values, columns, strict=True):
        assert value.shape == column.shape
        assert value.tobytes() == column.tobytes()


def test_a_message_that_differs_in_any_other_byte_is_left_to_the_general_decoder():
    columns, layout = made(topics.JOINT_STATES)
    whole = layout.encode(STAMPS, columns)
    accepted = 0
    for place in range(len(whole[0])):
        changed = bytearray(whole[2])
        changed[place] ^= 0x15
        found = layout.decode([*whole[:2], bytes(changed)])
        if found is None:
            continue
        accepted += 1
        message = decode(bytes(changed), topics.JOINT_STATES.type)
        assert found[0][2] == stamp_ns(message)
        for value, column in zip(topics.JOINT_STATES.values(message), found[1], strict=True):
            assert np.asarray(value).tobytes() == column[2].tobytes()
    numbers = sum(column[0].size for column in columns)
    assert accepted == 8 * numbers + 8 + 2, 'numbers, stamp and the two option bytes'
    assert layout.decode([whole[0], whole[1][:-8]]) is None
