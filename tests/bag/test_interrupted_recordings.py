# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A recorder that is killed or runs out of space: its error, and what is read of its bag."""

import json
import os
import shutil
import signal
import subprocess
import sys
import textwrap

import numpy as np
import pytest
from mcap.reader import make_reader
from support.made_bags import Bags, random_trajectory
from waiting import WITHIN_S

from ddct_bringup import api
from ddct_bringup.bag.reader import mcap_of, read_bag
from ddct_bringup.logs.columns import own_columns
from ddct_bringup.logs.log import read_log
from ddct_bringup.programs import report, score
from ddct_bringup.run.timing_and_failure import note_failure
from ddct_plant.bag_file.records import read_records
from ddct_plant.base.errors import DdctError

TICKS_PER_CHUNK = 64 * 1024 // 2000
"""Largest number of ticks in a chunk: a tick takes at least 2000 bytes."""

COPY_BAG = """
    import resource, sys
    from pathlib import Path
    from ddct_plant.bag_file.records import read_records
    from ddct_bringup.bag.writer import BagWriter
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
        writer = BagWriter(folder, 'copy', topics, records.custom_data)
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
        assert process.wait(timeout=WITHIN_S) == -signal.SIGKILL
    return source, folder


@pytest.fixture
def source(recorded, tmp_path):
    """Return a copy of the whole bag."""
    return shutil.copytree(recorded[0], tmp_path / 'source')


@pytest.fixture
def killed(recorded, tmp_path):
    """Return a copy of the killed writer's bag."""
    return shutil.copytree(recorded[1], tmp_path / 'killed')


def test_a_killed_recording_is_read_but_its_last_chunk(killed, source):
    assert not (killed / 'metadata.yaml').exists()
    before = mcap_of(killed).read_bytes()
    recording = read_bag(killed)
    assert recording.unfinished
    steps = recording.trajectory.steps
    assert 150 - TICKS_PER_CHUNK <= steps < 150
    whole = read_bag(source)
    assert not whole.unfinished
    for name, values in whole.trajectory.signals.items():
        expected = values[: steps + 1]
        assert np.array_equal(recording.trajectory.signals[name], expected), name
    assert recording.run_info == whole.run_info
    assert recording.custom_data == whole.custom_data
    assert [(file.name, file.read_bytes()) for file in killed.iterdir()] == [
        ('copy_0.mcap', before)
    ]


def test_a_killed_recording_is_invalid_with_its_number_of_steps_and_without_figures(
    killed, capsys
):
    steps = read_bag(killed).trajectory.steps
    reason = f'incomplete: {steps} of 200 steps: if its recorder still runs, stop it first'
    assert score.main([str(killed), '--json', '-']) == 1
    captured = capsys.readouterr()
    (run,) = json.loads(captured.out)['runs']
    assert (run['valid'], run['state'], run['reason']) == (False, 'invalid', reason)
    assert run['controller'] == 'pi'
    assert {*run['metrics'].values(), *run['figures'].values()} == {None}
    assert reason in ' '.join(captured.err.split())
    loaded = api.load(killed)
    assert (loaded.valid, loaded.state, loaded.reason) == (False, 'invalid', reason)
    assert {*loaded.metrics.values()} == {None}
    assert loaded.recording.trajectory.steps == steps


def test_a_report_of_a_killed_recording_shows_its_signals_and_the_reason(killed, tmp_path):
    page = tmp_path / 'report.html'
    assert report.main([str(killed), '--out', str(page)]) == 1
    steps = read_bag(killed).trajectory.steps
    assert f'incomplete: {steps} of 200 steps' in page.read_text(encoding='utf-8')


def test_the_reason_of_a_failed_run_is_named_after_how_much_of_it_there_is(killed, capsys):
    note_failure(killed, 'node recorder was killed by SIGKILL', read_bag(killed).custom_data)
    steps = read_bag(killed).trajectory.steps
    expected = f'incomplete: {steps} of 200 steps; node recorder was killed by SIGKILL'
    assert score.main([str(killed), '--json', '-']) == 1
    (run,) = json.loads(capsys.readouterr().out)['runs']
    assert (run['valid'], run['reason']) == (False, expected)


def test_the_log_of_a_killed_recording_ends_where_its_last_whole_tick_is(killed, source):
    part, whole = (read_log(bag, own_columns()) for bag in (killed, source))
    steps = read_bag(killed).trajectory.steps
    assert part.time_s[-1] == pytest.approx(steps / 100.0)
    rows = slice(0, len(part.time_s))
    assert np.array_equal(part.time_s, whole.time_s[rows])
    for name, values in part.signals.items():
        assert np.array_equal(values, whole.signals[name][rows], equal_nan=True), name


def test_a_chunk_is_whole_on_the_disk_as_soon_as_it_is_full(bags, source, tmp_path):
    file = tmp_path / 'copy' / 'copy_0.mcap'
    seen = []

    def watched(messages):
        size = file.stat().st_size
        for number, message in enumerate(messages, 1):
            yield message
            if file.stat().st_size > size:
                size = file.stat().st_size
                seen.append((number, sum(1 for _ in read_records(file).messages())))

    bags.rewrite(source, 'copy', watched)
    assert len(seen) > 2
    assert [held for _, held in seen] == [written for written, _ in seen]


def test_a_lost_metadata_file_is_no_damage(source):
    (source / 'metadata.yaml').unlink()
    assert not read_bag(source).unfinished


@pytest.mark.parametrize(
    ('length', 'message'),
    [
        *[(0, 'the file is empty'), (5, 'not an MCAP file')],
        *[(length, 'the recording ends before its first tick') for length in (8, 300, 3000)],
    ],
)
def test_a_recording_that_ends_at_its_beginning_is_refused(source, length, message):
    file = mcap_of(source)
    file.write_bytes(file.read_bytes()[:length])
    with pytest.raises(DdctError, match=f'pi_0.mcap: .*{message}'):
        read_bag(source)


def test_a_recording_that_ends_before_its_first_tick_is_refused(source):
    file = mcap_of(source)
    whole = file.read_bytes()
    with file.open('rb') as stream:
        first = make_reader(stream).get_summary().chunk_indexes[0]
    file.write_bytes(whole[: first.chunk_start_offset + first.chunk_length - 1])
    with pytest.raises(DdctError, match=r'pi_0.mcap: the recording ends before its first tick'):
        read_bag(source)


def test_a_file_size_limit_ends_recording_with_the_name_of_the_file(source, tmp_path):
    limit = mcap_of(source).stat().st_size // 2
    folder = tmp_path / 'limited'
    with copy_bag(source, folder, last_step=200, limit=limit) as process:
        output, errors = process.communicate(timeout=WITHIN_S)
    assert (process.returncode, output) == (1, '')
    assert f'{folder}/copy_0.mcap: cannot write the recording (File too large)' in errors
    assert 'Traceback' not in errors
    assert not (folder / 'metadata.yaml').exists()
    recording = read_bag(folder)
    assert recording.unfinished
    assert recording.trajectory.steps > 0


def test_a_disk_that_is_full_at_the_end_leaves_no_whole_bag(source, tmp_path):
    limit = mcap_of(source).stat().st_size - 100
    folder = tmp_path / 'limited'
    with copy_bag(source, folder, last_step=200, limit=limit) as process:
        _, errors = process.communicate(timeout=WITHIN_S)
    assert process.returncode == 1
    assert 'copy_0.mcap: cannot write the recording (File too large)' in errors
    assert not (folder / 'metadata.yaml').exists()
    recording = read_bag(folder)
    assert recording.unfinished
    assert recording.trajectory.steps == 200


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
        _, errors = process.communicate(timeout=WITHIN_S)
    assert process.returncode == 1
    assert 'copy_0.mcap: cannot write the recording (No space left on device)' in errors
