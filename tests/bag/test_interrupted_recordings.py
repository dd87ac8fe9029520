# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A recorder that is killed or runs out of space: its error, and the rescue of its bag."""

import os
import random
import shutil
import signal
import subprocess
import sys
import textwrap

import pytest
from mcap.reader import make_reader
from refusals import refused
from support.made_bags import Bags, random_trajectory

from ddct_bringup.bag import repair
from ddct_bringup.bag.reader import mcap_of, read_bag
from ddct_bringup.bag.repair import REPAIRED_KEY, repair_bag
from ddct_plant.bag_file.records import salvage_records
from ddct_plant.base.errors import DdctError

TICKS_PER_CHUNK = 64 * 1024 // 2000
"""Largest number of ticks in a chunk: a tick takes at least 2000 bytes."""

COPY_BAG = """
    import resource, sys
    from pathlib import Path
    from ddct_plant.bag_file.records import read_records
    from ddct_bringup.bag.writer import new_bag
    from ddct_plant.base.errors import DdctError
    from ddct_plant.signals.topics import TOPICS

    source, folder = map(Path, sys.argv[1:3])
    last_step, limit = map(int, sys.argv[3:])
    records = read_records(source)
    recorded = {channel.topic for channel in records.channels.values()}
    topics = [topic for topic in TOPICS if topic.resolved_name in recorded]
    if limit:
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    try:
        writer = new_bag(folder, 'copy', topics, records.custom_data)
        for topic, stamp, data in records.messages():
            if stamp > 1_000_000_000 + last_step * 10_000_000:
                break
            writer.write(topic, stamp, data)
        else:
            writer.close()
    except DdctError as error:
        writer.close()
        sys.exit(str(error))
    print('waiting to be killed', flush=True)
    sys.stdin.read()
"""


def copy_bag(source, folder, *, last_step, limit=0):
    """Start a program that copies the ticks up to `last_step` and then waits."""
    arguments = [str(mcap_of(source)), str(folder), str(last_step), str(limit)]
    return subprocess.Popen(
        [sys.executable, '-c', textwrap.dedent(COPY_BAG), *arguments],
        env={**os.environ, 'PYTHONPATH': os.pathsep.join(filter(None, sys.path))},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


@pytest.fixture(scope='module')
def recorded(tmp_path_factory):
    """Return a whole bag, and that of a writer that was killed after 150 of 200 steps."""
    bags = Bags(tmp_path_factory.mktemp('recorded'))
    source, folder = bags.write(random_trajectory(200), folder='source'), bags.folder / 'killed'
    with copy_bag(source, folder, last_step=150) as process:
        line = process.stdout.readline()
        process.send_signal(signal.SIGKILL)
        assert line == 'waiting to be killed\n', process.stderr.read()
        assert process.wait(timeout=30.0) == -signal.SIGKILL
    return source, folder


@pytest.fixture
def source(recorded, tmp_path):
    """Return a copy of the whole bag."""
    return shutil.copytree(recorded[0], tmp_path / 'source')


@pytest.fixture
def killed(recorded, tmp_path):
    """Return a copy of the killed writer's bag."""
    return shutil.copytree(recorded[1], tmp_path / 'killed')


def test_a_killed_recording_is_not_taken_for_a_whole_one(killed):
    assert not (killed / 'metadata.yaml').exists()
    with pytest.raises(DdctError, match=r'copy_0.mcap: .*unfinished.*ddct score --repair'):
        read_bag(killed)


def test_a_killed_recording_loses_at_most_one_chunk(killed, source):
    damaged = mcap_of(killed).read_bytes()
    repair = repair_bag(killed)
    assert 150 - TICKS_PER_CHUNK <= repair.last_step < 150
    recording = read_bag(killed)
    assert recording.trajectory.steps == repair.last_step
    assert recording.custom_data[REPAIRED_KEY] == 'true'
    expected = read_bag(source).trajectory.slip_speed[: repair.last_step + 1]
    assert recording.trajectory.slip_speed.tolist() == expected.tolist()
    assert repair.original.read_bytes() == damaged
    assert sorted(file.name for file in killed.iterdir()) == [
        'copy_0.mcap',
        'copy_0.mcap.damaged',
        'metadata.yaml',
    ]


def test_a_chunk_is_whole_on_the_disk_as_soon_as_it_is_full(bags, source, tmp_path):
    file = tmp_path / 'copy' / 'copy_0.mcap'
    seen = []

    def watched(messages):
        size = file.stat().st_size
        for number, message in enumerate(messages, 1):
            yield message
            if file.stat().st_size > size:
                size = file.stat().st_size
                seen.append((number, sum(1 for _ in salvage_records(file).messages())))

    bags.rewrite(source, 'copy', watched)
    assert len(seen) > 2
    assert [held for _, held in seen] == [written for written, _ in seen]


def test_a_repaired_bag_is_read_by_rosbags(killed):
    rosbag2 = pytest.importorskip('rosbags.rosbag2', reason='rosbags reads the bag')
    repair = repair_bag(killed)
    with rosbag2.Reader(killed) as reader:
        assert reader.message_count == 2 + 15 * (repair.last_step + 1)
        assert sum(1 for _ in reader.messages()) == reader.message_count


def test_repairing_a_whole_bag_changes_nothing(source):
    before = {file.name: file.read_bytes() for file in source.iterdir()}
    repair = repair_bag(source)
    assert (repair.original, repair.last_step) == (None, 200)
    assert {file.name: file.read_bytes() for file in source.iterdir()} == before


def test_repairing_restores_lost_metadata(source):
    text = (source / 'metadata.yaml').read_text()
    (source / 'metadata.yaml').unlink()
    assert repair_bag(source).original is None
    assert (source / 'metadata.yaml').read_text() == text


def test_repair_keeps_what_is_before_the_damage(source):
    file = mcap_of(source)
    damaged = bytearray(file.read_bytes())
    with file.open('rb') as stream:
        chunks = make_reader(stream).get_summary().chunk_indexes
    middle = chunks[len(chunks) // 2]
    damaged[middle.chunk_start_offset + middle.chunk_length // 2] ^= 0xFF
    file.write_bytes(damaged)
    expected = 100
    repair = repair_bag(source)
    assert expected - 2 * TICKS_PER_CHUNK <= repair.last_step <= expected + 2 * TICKS_PER_CHUNK
    assert read_bag(source).trajectory.steps == repair.last_step
    assert repair.original.read_bytes() == damaged


def test_whatever_bit_is_flipped_only_true_values_are_rescued(bags, trajectory):
    source = bags.write(trajectory)
    file = mcap_of(source)
    whole = file.read_bytes()
    expected = read_bag(source).trajectory.joint_speed.tolist()
    rng = random.Random(7)
    for _ in range(8):
        damaged = bytearray(whole)
        damaged[rng.randrange(len(whole))] ^= 1 << rng.randrange(8)
        file.write_bytes(damaged)
        try:
            repair = repair_bag(source)
        except DdctError:
            assert file.read_bytes() == damaged
            continue
        rescued = read_bag(source).trajectory.joint_speed.tolist()
        assert rescued == expected[: repair.last_step + 1]
        repair.original.unlink()


def test_a_rescued_file_that_cannot_be_read_back_replaces_nothing(source, monkeypatch):
    """The disk reports success for bytes that it has not written."""

    def write_badly(path, *rest):
        write(path, *rest)
        path.write_bytes(path.read_bytes()[:-100])

    file = mcap_of(source)
    file.write_bytes(file.read_bytes()[:-3000])
    before = {each.name: each.read_bytes() for each in source.iterdir()}
    write = repair._write
    monkeypatch.setattr(repair, '_write', write_badly)
    with refused(DdctError, place='pi_0.mcap'):
        repair_bag(source)
    assert {each.name: each.read_bytes() for each in source.iterdir()} == before


def test_a_second_repair_keeps_the_first_damaged_file(source):
    file = mcap_of(source)
    for cut in (3000, 2000):
        file.write_bytes(file.read_bytes()[:-cut])
        repair_bag(source)
    kept = sorted(each.name for each in source.glob('*.damaged*'))
    assert kept == ['pi_0.mcap.damaged', 'pi_0.mcap.damaged2']


@pytest.mark.parametrize('length', [0, 5, 8, 300])
def test_nothing_to_rescue_is_an_error_and_leaves_the_file_alone(source, length):
    file = mcap_of(source)
    file.write_bytes(file.read_bytes()[:length])
    with pytest.raises(DdctError) as caught:
        repair_bag(source)
    assert str(file) in caught.value.place
    assert file.stat().st_size == length
    assert sorted(each.name for each in source.iterdir()) == ['metadata.yaml', 'pi_0.mcap']


def test_a_file_size_limit_ends_recording_with_the_name_of_the_file(source, tmp_path):
    limit = mcap_of(source).stat().st_size // 2
    folder = tmp_path / 'limited'
    with copy_bag(source, folder, last_step=200, limit=limit) as process:
        output, errors = process.communicate(timeout=30.0)
    assert (process.returncode, output) == (1, '')
    assert f'{folder}/copy_0.mcap: cannot write the recording (File too large)' in errors
    assert 'Traceback' not in errors
    assert not (folder / 'metadata.yaml').exists()
    with refused(DdctError, place='copy_0.mcap'):
        read_bag(folder)
    assert repair_bag(folder).last_step > 0


def test_a_disk_that_is_full_at_the_end_leaves_no_whole_bag(source, tmp_path):
    limit = mcap_of(source).stat().st_size - 100
    folder = tmp_path / 'limited'
    with copy_bag(source, folder, last_step=200, limit=limit) as process:
        _, errors = process.communicate(timeout=30.0)
    assert process.returncode == 1
    assert 'copy_0.mcap: cannot write the recording (File too large)' in errors
    assert not (folder / 'metadata.yaml').exists()
    with refused(DdctError, place='copy_0.mcap'):
        read_bag(folder)
    assert repair_bag(folder).last_step == 200


@pytest.fixture
def small_disk(tmp_path):
    """Mount a file system of 128 KiB."""
    if os.geteuid() != 0 or shutil.which('mount') is None:
        pytest.skip('only root can mount a small file system')
    folder = tmp_path / 'small'
    folder.mkdir()
    command = ['mount', '-t', 'tmpfs', '-o', 'size=128k', 'tmpfs', str(folder)]
    mounted = subprocess.run(command, capture_output=True, text=True)
    if mounted.returncode:
        pytest.skip(f'a small file system cannot be mounted: {mounted.stderr.strip()}')
    yield folder
    subprocess.run(['umount', str(folder)], check=True)


def test_a_full_disk_is_named_as_such(source, small_disk):
    assert mcap_of(source).stat().st_size > 128 * 1024
    with copy_bag(source, small_disk / 'bag', last_step=200) as process:
        _, errors = process.communicate(timeout=30.0)
    assert process.returncode == 1
    assert 'copy_0.mcap: cannot write the recording (No space left on device)' in errors


def test_repair_on_a_full_disk_leaves_the_damaged_file_alone(killed, small_disk):
    folder = small_disk / 'bag'
    folder.mkdir()
    file = folder / 'copy_0.mcap'
    shutil.copy(mcap_of(killed), file)
    before = file.read_bytes()
    assert len(before) > 64 * 1024
    with pytest.raises(DdctError, match='No space left on device'):
        repair_bag(folder)
    assert file.read_bytes() == before
    assert [each.name for each in folder.iterdir()] == ['copy_0.mcap']
