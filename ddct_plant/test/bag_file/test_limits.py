# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The number of records of a bag is bounded by its duration and by the size of its file."""

import io
from pathlib import Path

import pytest
from mcap.writer import CompressionType, IndexType, Writer
from refusals import refused

from ddct_plant.bag_file import limits, records
from ddct_plant.bag_file.limits import MOST_CHANNELS, MOST_STEP_RECORDS, SPARE_RECORDS
from ddct_plant.bag_file.metadata import RECORD_NAME, metadata_record
from ddct_plant.bag_file.records import read_records, salvage_records
from ddct_plant.base.errors import DdctError

MANY = 60_000
HOUR = {'duration_s': '3600.0'}


def bag_of_messages(file: Path, facts: dict[str, str], *, count: int = MANY, **options) -> None:
    """Write a bag with `count` empty messages in one chunk."""
    stream = io.BytesIO()
    writer = Writer(stream, chunk_size=10**8, compression=CompressionType.ZSTD, **options)
    writer.start('ros2', 'test')
    writer.add_metadata(RECORD_NAME, metadata_record({'custom_data': facts}))
    channel = writer.register_channel('/nothing', 'cdr', 0, {})
    for stamp in range(count):
        writer.add_message(channel, 0, b'', stamp)
    writer.finish()
    file.write_bytes(stream.getvalue())


def read_until_refused(file: Path) -> int:
    """Return the number of messages that are read before the bag is refused."""
    count = 0
    with refused(DdctError, place=file.name):
        for _ in read_records(file).messages():
            count += 1
    return count


def test_a_file_holds_no_more_messages_than_entries_of_its_index(tmp_path: Path) -> None:
    file = tmp_path / 'bomb.mcap'
    bag_of_messages(file, HOUR, index_types=IndexType.NONE)
    size = file.stat().st_size
    assert read_until_refused(file) <= SPARE_RECORDS + size // 16 < MANY


def test_a_short_run_has_few_messages_in_a_large_file_too(tmp_path: Path) -> None:
    file = tmp_path / 'bomb.mcap'
    bag_of_messages(file, {'duration_s': '0.01'})
    assert file.stat().st_size > 16 * MANY
    assert read_until_refused(file) <= SPARE_RECORDS + MOST_STEP_RECORDS


@pytest.mark.parametrize('facts', [HOUR, {}])
def test_messages_with_their_index_are_read(tmp_path: Path, facts: dict[str, str]) -> None:
    file = tmp_path / 'long.mcap'
    bag_of_messages(file, facts)
    assert sum(1 for _ in read_records(file).messages()) == MANY


def test_the_records_that_are_rescued_are_bounded_too(tmp_path: Path) -> None:
    file = tmp_path / 'bomb.mcap'
    bag_of_messages(file, HOUR, index_types=IndexType.NONE)
    assert 0 < sum(1 for _ in salvage_records(file).messages()) < MANY


def test_a_small_file_is_not_unpacked_to_the_size_of_an_hour(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / 'bomb.mcap'
    bag_of_messages(file, HOUR, count=10, index_types=IndexType.NONE)
    monkeypatch.setattr(limits, 'SPARE_BYTES', 0)
    monkeypatch.setattr(limits, 'MOST_STEP_BYTES', 10)
    monkeypatch.setattr(records, 'in_chunk', None)  # refused before anything is unpacked
    assert read_until_refused(file) == 0


def test_channels_are_bounded(tmp_path: Path) -> None:
    stream = io.BytesIO()
    writer = Writer(stream)
    writer.start('ros2', 'test')
    for number in range(MOST_CHANNELS + 1):
        writer.register_channel(f'/{number}', 'cdr', 0, {})
    writer.finish()
    file = tmp_path / 'bomb.mcap'
    file.write_bytes(stream.getvalue())
    assert read_until_refused(file) == 0


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
    bag_of_messages(file, facts, count=1)
    monkeypatch.setattr(records, 'in_chunk', None)
    for read in (read_records, salvage_records):
        with refused(DdctError, 'duration_s', place='edited.mcap'):
            read(file)
