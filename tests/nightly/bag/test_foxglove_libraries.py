# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The npm libraries that Foxglove is built on read every message of our bags."""

import json
import re
import shutil
import subprocess
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from waiting import WITHIN_S

from ddct_bringup.bag.reader import mcap_of

SCRIPTS = Path(__file__).parent / 'npm'
UNREACHABLE = {
    'EAI_AGAIN',
    'ECONNREFUSED',
    'ECONNRESET',
    'EHOSTUNREACH',
    'ENETUNREACH',
    'ENOTCACHED',
    'ENOTFOUND',
    'ERR_SOCKET_TIMEOUT',
    'ETIMEDOUT',
}


@pytest.fixture(scope='module')
def reader_script(tmp_path_factory):
    """Install the libraries into a fresh folder and return the script in it."""
    if not (shutil.which('node') and shutil.which('npm')):
        pytest.skip('node and npm are not installed')
    folder = tmp_path_factory.mktemp('npm')
    for file in SCRIPTS.iterdir():
        if file.is_file():
            shutil.copy(file, folder)
    command = ['npm', 'ci', '--ignore-scripts', '--no-audit', '--no-fund', '--fetch-retries=1']
    try:
        result = subprocess.run(
            command, cwd=folder, capture_output=True, text=True, timeout=3 * WITHIN_S
        )
    except subprocess.TimeoutExpired:
        pytest.skip('npm ci did not end in time: the package registry may be unreachable')
    codes = set(re.findall(r'\bcode (\w+)', result.stderr))
    if codes & UNREACHABLE:
        pytest.skip(f'the npm package registry cannot be reached ({", ".join(sorted(codes))})')
    assert result.returncode == 0, result.stderr
    return folder / 'read_bag.mjs'


def plain(value):
    """Return a decoded message as the JSON that the script prints."""
    if isinstance(value, SimpleNamespace):
        return {name: plain(getattr(value, name)) for name in value.__slots__}
    if isinstance(value, (list, tuple)):
        return [plain(each) for each in value]
    return value


def by_topic(messages):
    result: dict[str, list[tuple[int, Any]]] = {}
    for topic, log_time, message in messages:
        result.setdefault(topic, []).append((log_time, message))
    return result


def test_foxglove_libraries_read_the_same_values(bags, trajectory, reader_script):
    file = mcap_of(bags.write(trajectory))
    result = subprocess.run(
        ['node', str(reader_script), str(file)],
        capture_output=True,
        text=True,
        timeout=3 * WITHIN_S,
    )
    assert result.returncode == 0, result.stderr
    lines = [json.loads(line) for line in result.stdout.splitlines()]
    read = [(line['topic'], int(line['logTime']), line['message']) for line in lines]
    with file.open('rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        expected = [
            (entry.channel.topic, entry.message.log_time, plain(entry.decoded_message))
            for entry in reader.iter_decoded_messages()
        ]
    assert len(read) == 2 + 15 * (trajectory.steps + 1)
    assert by_topic(read) == by_topic(expected)
