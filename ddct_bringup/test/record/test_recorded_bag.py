# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The recorder's bag holds reproducible messages of the types of their topics alone."""

import pytest
from refusals import refused

pytest.importorskip('rclpy', reason='the recorder serialises by rclpy')

from ddct_bringup.record.recorded_bag import RecordedBag  # noqa: E402
from ddct_bringup.record.run_info_collector import RunInfoCollector  # noqa: E402
from ddct_plant.bag_file.message_definitions import encode, message_class  # noqa: E402
from ddct_plant.bag_file.records import read_records  # noqa: E402
from ddct_plant.base.errors import DdctError  # noqa: E402
from ddct_plant.base.timebase import stamp_of_step  # noqa: E402
from ddct_plant.scenario.file import load_scenario  # noqa: E402
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from ddct_plant.signals import topics  # noqa: E402
from ddct_plant.signals.topic import RunKind  # noqa: E402

SLIP = topics.SLIP


class AllNodes(RunInfoCollector):
    """Collector to which every node has published."""

    controller, steps, torque_parts = 'pi', 300, True

    def __init__(self):
        pass

    def missing(self):
        return []

    def received(self):
        return {'/load': {'version': '1.0'}}


def message(topic, step, *values):
    return encode(topic.writer(message_class)(stamp_of_step(step), *values))


@pytest.fixture
def bag(tmp_path):
    settings = RunSettings(KnownSettings(load_scenario('thesis')))
    place = (tmp_path, 'pi')
    return RecordedBag(
        place, RunKind(), settings, AllNodes(), lambda stamp: message(topics.RECORDER_ACK, 0)
    )


@pytest.mark.process
def test_bytes_that_are_no_message_of_the_topic_are_refused(bag):
    with refused(DdctError, SLIP.name) as caught:
        bag.write_ticks([(3, {SLIP.name: b'\x00\x01\x00\x00' + bytes(8)})])
    assert f'at stamp {stamp_of_step(3)} ns: a message is no {SLIP.type}' in str(caught.value)


@pytest.mark.process
def test_bytes_without_a_value_are_zero_in_the_bag(bag, tmp_path):
    clean = message(SLIP, 0, 12.5)
    spoiled = clean[:2] + b'\x07\x03' + clean[4:] + b'\xaa' * 8
    bag.write_ticks([(0, {SLIP.name: spoiled})])
    bag.close()
    found = {topic: cdr for topic, _, cdr in read_records(tmp_path / 'pi_0.mcap').messages()}
    assert found[SLIP.resolved_name] == clean
    assert set(found) == {'/run_info', SLIP.resolved_name, '/recorder/ack'}
