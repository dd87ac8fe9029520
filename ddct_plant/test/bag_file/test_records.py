# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A file with a footer is read wholly or not at all, one without up to its last whole chunk."""

import io
import struct
from pathlib import Path

import pytest
from mcap.writer import CompressionType, Writer
from refusals import refused

from ddct_plant.bag_file.metadata import RECORD_NAME, metadata_record
from ddct_plant.bag_file.records import MAGIC, read_records, readable_custom_data
from ddct_plant.base.errors import DdctError

FACTS = {'controller': 'pi'}
COUNT = 40


def bag_of_messages(
    facts: dict[str, str] = FACTS,
    count: int = COUNT,
    chunk_bytes: int = 200,
    compression: CompressionType = CompressionType.ZSTD,
    checksums: bool = True,
) -> bytes:
    """Return a bag with messages whose numbers are their stamps, a few in each chunk."""
    stream = io.BytesIO()
    writer = Writer(
        stream,
        chunk_size=chunk_bytes,
        compression=compression,
        enable_crcs=checksums,
        enable_data_crcs=checksums,
    )
    writer.start('ros2', 'test')
    writer.add_metadata(RECORD_NAME, metadata_record({'custom_data': facts}))
    channel = writer.register_channel('/nothing', 'cdr', 0, {})
    for stamp in range(count):
        writer.add_message(channel, stamp, bytes([stamp % 256]), stamp)
    writer.add_metadata(RECORD_NAME, metadata_record({'custom_data': {**facts, 'last': 'yes'}}))
    writer.finish()
    return stream.getvalue()


def found_in(file: Path, data: bytes) -> list[tuple[str, int, bytes]]:
    file.write_bytes(data)
    return list(read_records(file).messages())


EXPECTED = [('/nothing', stamp, bytes([stamp])) for stamp in range(COUNT)]


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / 'bag.mcap'


@pytest.mark.parametrize('facts', [FACTS, {}])
@pytest.mark.parametrize('compression', CompressionType)
@pytest.mark.parametrize('chunk_bytes', [0, 200, 10**6])
def test_every_message_of_a_whole_file_is_read(file, facts, compression, chunk_bytes) -> None:
    whole = bag_of_messages(facts, chunk_bytes=chunk_bytes, compression=compression)
    assert found_in(file, whole) == EXPECTED
    records = read_records(file)
    assert not records.unfinished
    assert records.custom_data == {**facts, 'last': 'yes'}


def test_a_file_without_chunks_is_read(file) -> None:
    stream = io.BytesIO()
    writer = Writer(stream, use_chunking=False)
    writer.start('ros2', 'test')
    channel = writer.register_channel('/nothing', 'cdr', 0, {})
    writer.add_message(channel, 7, b'seven', 7)
    writer.finish()
    assert found_in(file, stream.getvalue()) == [('/nothing', 7, b'seven')]


def test_a_file_of_another_tool_without_checksums_is_read(file) -> None:
    whole = bag_of_messages(checksums=False)
    assert found_in(file, whole) == EXPECTED


def test_wherever_a_file_is_cut_the_messages_before_are_read(file) -> None:
    whole = bag_of_messages()
    counts = {}
    for length in {*range(len(MAGIC), len(whole), 31), *range(len(whole) - 40, len(whole))}:
        found = found_in(file, whole[:length])
        assert found == EXPECTED[: len(found)]
        assert read_records(file).unfinished
        counts[length] = len(found)
    in_order = [counts[length] for length in sorted(counts)]
    assert in_order == sorted(in_order)
    assert len({*in_order}) > 5, 'chunk by chunk'
    assert in_order[-1] == COUNT


def test_an_unfinished_file_is_read_until_a_damaged_chunk(file) -> None:
    whole = bag_of_messages(chunk_bytes=400)
    unfinished = whole[:-1000]
    before = len(found_in(file, unfinished))
    counts = set()
    for place in range(100, len(unfinished), 5):
        changed = bytearray(unfinished)
        changed[place] ^= 0x10
        found = found_in(file, bytes(changed))
        # One that is no longer a chunk is skipped, as that of a later version of MCAP: the hole
        # in the ticks shows it.
        assert [each for each in EXPECTED if each in found] == found
        counts.add(len(found))
    assert max(counts) == before
    assert len(counts) > 3


def test_a_flipped_bit_of_a_whole_file_is_refused(file) -> None:
    whole = bag_of_messages(count=8)
    for place in range(len(MAGIC), len(whole), 7):
        changed = bytearray(whole)
        changed[place] ^= 1 << place % 8
        file.write_bytes(changed)
        with refused(DdctError, place='bag.mcap'):
            read_records(file)


@pytest.mark.parametrize('size', [1, 9, 45, 333])
def test_a_zeroed_block_of_a_whole_file_is_refused_or_without_effect(file, size) -> None:
    whole = bag_of_messages(count=8)
    refusals = 0
    for start in range(len(MAGIC), len(whole) - 37, 9):
        changed = whole[:start] + bytes(len(whole[start : start + size])) + whole[start + size :]
        try:
            found = found_in(file, changed)
        except DdctError:
            refusals += 1
            continue
        if not read_records(file).unfinished:
            assert found == EXPECTED[:8]
            assert changed == whole or _only_a_checksum_is_missing(whole, changed)
    assert refusals > 10


def _only_a_checksum_is_missing(whole: bytes, changed: bytes) -> bool:
    """Return whether the one difference is in the record that ends the data, of 13 bytes."""
    at = whole.index(struct.pack('<BQ', 0x0F, 4))
    return whole[:at] == changed[:at] and whole[at + 13 :] == changed[at + 13 :]


@pytest.mark.parametrize(
    ('spoil', 'reason'),
    [
        (lambda whole: whole[:-1] + b'x', 'its end is no footer'),
        (lambda whole: whole[:-37] + b'x' + whole[-36:], 'its end is no footer'),
        (lambda whole: whole[:-12] + b'x' + whole[-11:], 'the checksum of the summary is wrong'),
        (
            lambda whole: whole.replace(struct.pack('<BQ', 0x0F, 4), struct.pack('<BQ', 0x80, 4)),
            'the end of its data is missing',
        ),
        (lambda whole: whole[:40] + whole[41:], 'the checksum of the summary is wrong'),
    ],
)
def test_a_file_with_half_of_a_footer_is_damaged_and_not_unfinished(file, spoil, reason) -> None:
    file.write_bytes(spoil(bag_of_messages()))
    with pytest.raises(DdctError, match=rf'bag.mcap: the recording is damaged \({reason}\)'):
        read_records(file)


@pytest.mark.parametrize(('data', 'reason'), [(b'', 'empty'), (b'hello', 'not an MCAP file')])
def test_a_file_that_is_no_mcap_is_named(file, data, reason) -> None:
    file.write_bytes(data)
    for read in (read_records, readable_custom_data):
        with pytest.raises(DdctError, match=f'bag.mcap: .*{reason}'):
            read(file)


def test_a_file_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    with pytest.raises(DdctError, match='cannot read the bag'):
        read_records(tmp_path)


def test_the_custom_data_of_a_damaged_file_can_be_read(file) -> None:
    whole = bag_of_messages()
    file.write_bytes(whole[: len(whole) // 2] + b'damage' + whole[len(whole) // 2 :])
    assert readable_custom_data(file) == FACTS
