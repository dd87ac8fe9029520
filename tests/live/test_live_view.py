# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A viewer of `live` receives the run as the bag has it, and the run is unchanged."""

from collections.abc import Callable
from pathlib import Path

import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from support.processes import Program, Programs
from support.runs import SHORT_S, bag_bytes, plan, record
from viewer import Viewer, address_in
from waiting import wait_until

from ddct_plant.bag_file.message_definitions import load_definition
from ddct_plant.base.timebase import START_NS
from ddct_plant.signals.message_kind import stamp_ns
from ddct_plant.signals.topic import RunKind
from ddct_plant.signals.topics import TOPICS, recorded_topics

Start = Callable[..., tuple[Program, str]]
TICK_TOPICS = [topic.resolved_name for topic in recorded_topics(RunKind()) if topic.every_tick]


def _decoded_bag(folder: Path) -> dict[tuple[str, int], str]:
    """Return every message of a tick in a bag, as text, by topic and stamp."""
    (file,) = folder.glob('*.mcap')
    with file.open('rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        return {
            (entry.channel.topic, entry.message.log_time): str(entry.decoded_message)
            for entry in reader.iter_decoded_messages(TICK_TOPICS)
        }


@pytest.mark.usefixtures('extras')
def test_a_viewer_of_bringup_receives_the_run_from_its_first_tick_and_the_bag_stays_the_same(
    programs: Programs, tmp_path: Path
) -> None:
    options = ['--controller', 'ls8', '--duration', str(SHORT_S), '--out', str(tmp_path / 'runs')]
    program = programs.start_module('ddct_bringup.programs.bringup', '--live', '0', *options)
    wait_until(lambda: 'ws://' in program.errors(), 'the address of the live view')
    with Viewer(address_in(program.errors())) as viewer:
        assert program.wait() == 0, program.errors()
    watched, alone = tmp_path / 'runs' / 'ls8', tmp_path / 'alone'
    record(plan('ls8', 'headless'), alone)
    assert bag_bytes(watched) == bag_bytes(alone)
    recorded = _decoded_bag(watched)
    for topic in TICK_TOPICS:
        seen = viewer.decoded(topic)
        # The recorder starts last. Best effort may lose some, too, on a busy machine.
        if topic != '/recorder/ack':
            assert seen[0][0] == START_NS, topic
            assert len(dict(seen)) > 50, topic
        for stamp, message in seen:
            assert stamp_ns(message) == stamp
            assert str(message) == recorded[topic, stamp]
    assert viewer.times == sorted(viewer.times)
    assert viewer.times[0] == START_NS
    assert viewer.times[-1] > START_NS


def test_every_topic_is_offered_with_the_schema_of_a_bag(live: Start) -> None:
    program, url = live()
    with Viewer(url) as viewer:
        wait_until(lambda: len(viewer.channels) == len(TOPICS), 'every channel')
    program.stop()
    offered = {channel['topic']: channel for channel in viewer.channels.values()}
    for topic in TOPICS:
        channel = offered[topic.resolved_name]
        assert (channel['encoding'], channel['schemaEncoding']) == ('cdr', 'ros2msg')
        assert channel['schemaName'] == topic.type
        assert channel['schema'] == load_definition(topic.type).schema_text
