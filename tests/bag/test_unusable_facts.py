# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A bag whose facts, names or metadata cannot be used is refused in one line."""

from pathlib import Path
from typing import Any

import pytest
from mcap.writer import CompressionType, Writer
from refusals import refused
from support.complaints import assert_one_line

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.programs.score import main as score
from ddct_plant.base.errors import DdctError

RED = '\x1b[31m'


def test_control_characters_of_a_bag_do_not_reach_the_terminal(
    bags, trajectory, capsys: pytest.CaptureFixture[str]
) -> None:
    def rename(messages):
        old = b'driveshaft\x00'
        new = f'{RED}shaft\x00'.encode().ljust(len(old), b'\x00')
        return [(topic, stamp, data.replace(old, new)) for topic, stamp, data in messages]

    bag = bags.rewrite(bags.write(trajectory), 'red', rename)
    assert score([str(bag), '--csv', '-']) == 1
    captured = capsys.readouterr()
    assert r'the joints are engine, primary_shaft, wheel, \x1b[31mshaft' in captured.err
    assert '\x1b' not in captured.err + captured.out


def test_a_folder_with_control_characters_is_printed_without(
    bags, trajectory, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = bags.write(trajectory, folder=f'run{RED}')
    for options in ([], ['--csv', '-']):
        assert score([str(bag), *options]) == 0
        captured = capsys.readouterr()
        assert '\x1b' not in captured.err + captured.out
        assert r'run\x1b[31m' in captured.out


@pytest.mark.parametrize(
    ('key', 'value'),
    [('controller', f'{RED}pi'), ('name', RED), ('score_window_s', [-1e308, 1e308])],
)
def test_a_setting_that_cannot_be_used_is_one_line(
    bags, trajectory, capsys: pytest.CaptureFixture[str], key: str, value: Any
) -> None:
    bag = bags.rewrite(bags.write(trajectory), 'odd', **{key: value})
    assert score([str(bag)]) == 1
    errors = capsys.readouterr().err
    assert_one_line(errors, 'ddct score', key)
    assert errors.rstrip('\n').isprintable()


@pytest.mark.parametrize(
    'metadata',
    [
        'custom_data: !!python/object/apply:os.abort []',
        'custom_data: [',
        'custom_data: {controller: pi, controller: ls8}',
    ],
)
def test_metadata_that_is_no_plain_yaml_counts_as_none(tmp_path: Path, metadata: str) -> None:
    file = tmp_path / 'odd.mcap'
    with file.open('wb') as stream:
        writer = Writer(stream, compression=CompressionType.NONE)
        writer.start(profile='ros2')
        writer.add_metadata('rosbag2', {'serialized_metadata': metadata})
        schema = writer.register_schema('sensor_msgs/msg/JointState', 'ros2msg', b'')
        writer.register_channel('/driveline/joint_states', 'cdr', schema)
        writer.finish()
    with refused(DdctError, 'settings', place='odd.mcap'):
        read_bag(file)
