# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rescue the complete ticks of an interrupted or damaged recording."""

import tempfile
from array import array
from collections import defaultdict
from dataclasses import dataclass
from itertools import chain, count
from pathlib import Path

from ddct_bringup.bag.reader import recording_of
from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.bag.ticks import complete_ticks, tick_topics
from ddct_bringup.bag.writer import BagWriter
from ddct_plant.bag_file.metadata import (
    HASH_KEY,
    METADATA_FILE,
    QOS_KEY,
    Channel,
    write_metadata,
)
from ddct_plant.bag_file.records import BagRecords, read_records, salvage_records
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import stamp_of_step, time_of_step
from ddct_plant.files.input_file import located, mcap_of

REPAIRED_KEY = 'repaired'
"""Key in the custom data of a repaired bag; its value is 'true'."""


@dataclass(frozen=True)
class Repair:
    """Result of repairing one recording."""

    path: Path
    """Path of the MCAP file, complete now."""
    original: Path | None
    """Path where the damaged file is kept; None when the bag was complete before."""
    last_step: int
    """Step of the last complete tick; it and all ticks before it are kept."""
    dropped: int
    """Number of readable messages after that tick, which are left out."""

    def __str__(self) -> str:
        kept = f'steps 0 to {self.last_step} ({time_of_step(self.last_step):g} s)'
        if self.original is None:
            return f'{self.path}: whole, with {kept}'
        return (
            f'{self.path}: rescued {kept}, left out {self.dropped} messages after them; '
            f'the damaged file is {self.original.name}'
        )


def repair_bag(path: Path) -> Repair:
    """
    Repair an unfinished or damaged bag, given as its folder or its .mcap file.

    The new file contains every tick up to the first incomplete one. It is written and read
    back before it takes the place of the damaged file, which is kept beside it. A complete
    file that only lacks its `metadata.yaml` gets one. Raise DdctError when nothing can be
    rescued.
    """
    mcap = mcap_of(path)
    try:
        records = read_records(mcap)
        last_step = recording_of(records).trajectory.steps
    except DdctError:
        return _rewrite(mcap)
    if not (mcap.parent / METADATA_FILE).exists():
        write_metadata(mcap.parent, records.information)
    return Repair(mcap, None, last_step, 0)


def _rewrite(mcap: Path) -> Repair:
    records = salvage_records(mcap)
    with located(f'{mcap}: cannot be repaired'):
        last_step = _last_whole_tick(records)
        with _scratch_folder(mcap) as scratch:
            new = Path(scratch) / mcap.name
            dropped = _write(new, records, stamp_of_step(last_step))
            recording_of(read_records(new))
            original = _swap(new, mcap)
    return Repair(mcap, original, last_step, dropped)


def _write(path: Path, records: BagRecords, last_ns: int) -> int:
    """
    Write the messages up to a stamp in ns, and return the number of the others.

    They have the channels of the damaged file, so that nothing else is needed.
    """
    try:
        channels = [
            Channel(
                channel.topic,
                records.schemas[channel.schema_id].name,
                records.schemas[channel.schema_id].data.decode(),
                channel.metadata[HASH_KEY],
                channel.metadata[QOS_KEY],
            )
            for channel in records.channels.values()
        ]
    except (LookupError, UnicodeDecodeError) as error:
        raise DdctError(f'what it says of its channels is unusable ({error!r})') from error
    with BagWriter(path, channels, {**records.custom_data, REPAIRED_KEY: 'true'}) as bag:
        dropped = 0
        for topic, stamp, data in records.messages():
            if stamp > last_ns:
                dropped += 1
            else:
                bag.write(topic, stamp, data)
    return dropped


def _last_whole_tick(records: BagRecords) -> int:
    """Return the step of the last complete tick; raise DdctError without one."""
    facts = RunFacts.from_custom_data(records.custom_data)
    stamps: dict[str, array[int]] = defaultdict(lambda: array('q'))
    for topic, stamp, _ in records.messages():
        if stamp <= stamp_of_step(facts.steps):
            stamps[topic].append(stamp)
    run = facts.kind_of_bag(records.topics)
    ticks = complete_ticks(stamps, tick_topics(run, replies=run.lockstep))
    if not ticks:
        raise DdctError('it holds no complete tick')
    return ticks - 1


def _scratch_folder(mcap: Path) -> 'tempfile.TemporaryDirectory[str]':
    """Return a folder on the same file system, so that moving out of it cannot fail half-way."""
    try:
        return tempfile.TemporaryDirectory(prefix='.repair-', dir=mcap.parent)
    except OSError as error:
        raise DdctError(f'{mcap.parent}: cannot write there: {error.strerror}') from error


def _swap(new: Path, mcap: Path) -> Path:
    """Move the new bag to the place of the damaged one; return the path where that is kept."""
    numbers = chain([''], count(2))
    places = (mcap.with_name(f'{mcap.name}.damaged{number}') for number in numbers)
    original = next(place for place in places if not place.exists())
    try:
        mcap.rename(original)
        new.rename(mcap)
        (new.parent / METADATA_FILE).replace(mcap.parent / METADATA_FILE)
    except OSError as error:
        raise DdctError(f'{error.filename}: {error.strerror}') from error
    return original
