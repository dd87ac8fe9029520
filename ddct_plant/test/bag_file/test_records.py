# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The chunks of a bag are bounded, each and together, before they are unpacked."""

import io
import random
import zlib
from pathlib import Path

import lz4.frame
import pytest
from mcap.records import Chunk
from mcap.writer import CompressionType, Writer
from refusals import refused

from ddct_plant.bag_file import limits, records
from ddct_plant.bag_file.metadata import RECORD_NAME, metadata_record
from ddct_plant.bag_file.record_scan import in_chunk
from ddct_plant.bag_file.records import read_records, salvage_records
from ddct_plant.base.errors import DdctError

SIZE = 900_000
COUNT = 40
NOISE = 1000
"""Bytes of each message that do not compress, so that the file has room for its steps."""


def bag_of_zeros(file: Path, facts: dict[str, str]) -> None:
    """Write a bag with COUNT chunks, each of one message of SIZE bytes, nearly all of them 0."""
    noise = random.Random(1)
    stream = io.BytesIO()
    writer = Writer(stream, chunk_size=SIZE, compression=CompressionType.ZSTD)
    writer.start('ros2', 'test')
    writer.add_metadata(RECORD_NAME, metadata_record({'custom_data': facts}))
    channel = writer.register_channel('/zeros', 'cdr', 0, {})
    for stamp in range(COUNT):
        data = noise.randbytes(NOISE) + bytes(SIZE - NOISE)
        writer.add_message(channel, stamp, data, stamp)
    writer.finish()
    file.write_bytes(stream.getvalue())


def test_the_chunks_of_a_bag_may_have_the_size_that_its_duration_permits(tmp_path: Path) -> None:
    file = tmp_path / 'long.mcap'
    bag_of_zeros(file, {'duration_s': '3.0'})
    assert sum(len(data) for _, _, data in read_records(file).messages()) == COUNT * SIZE


@pytest.mark.parametrize('facts', [{'duration_s': '0.01'}, {}])
def test_more_is_refused_before_any_chunk_is_unpacked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, facts: dict[str, str]
) -> None:
    file = tmp_path / 'bomb.mcap'
    bag_of_zeros(file, facts)
    assert file.stat().st_size < 100_000
    monkeypatch.setattr(limits, 'MOST_UNPACKED_BYTES', COUNT * SIZE - 1)
    monkeypatch.setattr(records, 'in_chunk', None)
    with refused(DdctError, place='bomb.mcap'):
        read_records(file)


def test_what_is_rescued_of_a_bag_is_bounded_too(tmp_path: Path) -> None:
    file = tmp_path / 'bomb.mcap'
    bag_of_zeros(file, {'duration_s': '0.01'})
    size = sum(len(data) for _, _, data in salvage_records(file).messages())
    assert 0 < size <= limits.SPARE_BYTES + limits.MOST_STEP_BYTES


def test_a_chunk_of_lz4_is_unpacked_to_its_declared_size_only() -> None:
    data = bytes(10_000_000)
    checksum = zlib.crc32(data[:1000])
    chunk = Chunk('lz4', lz4.frame.compress(data, store_size=False), 0, 0, checksum, 1000)
    with pytest.raises(ValueError, match='more than its 1000 bytes'):
        list(in_chunk(chunk, limits.Allowance(len(data), None)))
