# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The recorder writes every tick exactly once on every topic; read without the own reader."""

from collections import Counter, defaultdict
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from support.runs import plan, record

from ddct_plant.signals.topic import RunKind
from ddct_plant.signals.topics import recorded_topics

STEPS = 100
STAMPS = [1_000_000_000 + step * 10_000_000 for step in range(STEPS + 1)]


def _stamp(message: Any) -> int:
    header = getattr(message, 'header', message)
    time = getattr(header, 'stamp', None) or message.clock
    return time.sec * 1_000_000_000 + time.nanosec


@pytest.mark.parametrize('layout', ['processes', 'single-process'])
def test_every_topic_holds_every_stamp_once_and_in_order(tmp_path: Path, layout: str) -> None:
    run = plan(layout=layout, duration_s=STEPS / 100)
    record(run, tmp_path / 'bag')
    stamps = defaultdict(list)
    with (tmp_path / 'bag' / 'ls8_0.mcap').open('rb') as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for _, channel, entry, message in reader.iter_decoded_messages(log_time_order=False):
            assert _stamp(message) == entry.log_time == entry.publish_time
            stamps[channel.topic].append(entry.log_time)
    topics = recorded_topics(RunKind())
    assert set(stamps) == {topic.resolved_name for topic in topics}
    for topic in topics:
        if topic.every_tick:
            assert stamps[topic.resolved_name] == STAMPS, topic.name
    assert Counter(stamps['/run_info']) == {STAMPS[0]: 8}
