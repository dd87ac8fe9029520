# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The records of a bag are read, and a duration that no run has is refused."""

import io
from pathlib import Path

import pytest
from mcap.writer import CompressionType, Writer
from refusals import refused

from ddct_plant.bag_file import records
from ddct_plant.bag_file.metadata import RECORD_NAME, metadata_record
from ddct_plant.bag_file.records import read_records, salvage_records
from ddct_plant.base.errors import DdctError

HOUR = {'duration_s': '3600.0'}


def bag_of_messages(
    file: Path, facts: dict[str, str], count: int, compression: CompressionType
) -> None:
    """Write a bag with `count` empty messages in one chunk."""
    stream = io.BytesIO()
    writer = Writer(stream, chunk_size=10**8, compression=compression)
    writer.start('ros2', 'test')
    writer.add_metadata(RECORD_NAME, metadata_record({'custom_data': facts}))
    channel = writer.register_channel('/nothing', 'cdr', 0, {})
    for stamp in range(count):
        writer.add_message(channel, 0, b'', stamp)
    writer.finish()
    file.write_bytes(stream.getvalue())


@pytest.mark.parametrize('facts', [HOUR, {}])
@pytest.mark.parametrize('compression', CompressionType)
def test_every_message_is_read_and_rescued(
    tmp_path: Path, facts: dict[str, str], compression: CompressionType
) -> None:
    file = tmp_path / 'long.mcap'
    bag_of_messages(file, facts, 2000, compression)
    for read in (read_records, salvage_records):
        assert [stamp for _, stamp, _ in read(file).messages()] == [0] * 2000


@pytest.mark.parametrize(
    'facts',
    [
        {'duration_s': '3600.01'},
        {'duration_s': '0.0'},
        {'duration_s': 'long'},
        {**HOUR, 'scenario_yaml': 'duration_s: 3.0'},
    ],
)
def test_a_duration_that_no_run_has_is_refused_before_anything_is_unpacked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, facts: dict[str, str]
) -> None:
    file = tmp_path / 'edited.mcap'
    bag_of_messages(file, facts, 1, CompressionType.ZSTD)
    monkeypatch.setattr(records, 'in_chunk', None)
    for read in (read_records, salvage_records):
        with refused(DdctError, 'duration_s', place='edited.mcap'):
            read(file)
