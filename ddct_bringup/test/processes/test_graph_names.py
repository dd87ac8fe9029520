# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Names of a graph: remaps that mean the same for every node, and no others."""

import pytest
from refusals import refused

from ddct_bringup.processes.graph_names import GraphNames
from ddct_plant.base.errors import ParameterError
from ddct_plant.program.command_line import split_ros_arguments

CAR = ['-r', '__ns:=/car', '--remap', '/clock:=/car/clock']


def test_remaps_name_the_graph_and_its_off_going_side():
    own, for_ros = split_ros_arguments(['--out', 'a', '--ros-args', *CAR, '--', '--overwrite'])
    names = GraphNames.of(for_ros)
    assert own == ['--out', 'a', '--overwrite']
    assert names.resolved('/clock') == '/car/clock'
    assert names.remaps() == ['-r', '__ns:=/car', '-r', '/clock:=/car/clock']
    assert names.remaps('off_going')[1] == '__ns:=/car/off_going'
    assert GraphNames().remaps('off_going') == ['-r', '__ns:=/off_going']
    assert split_ros_arguments(['--out', 'a']) == (['--out', 'a'], [])
    assert GraphNames.of([]) == GraphNames()


@pytest.mark.parametrize(
    'arguments',
    [
        ['-p', 'wear_gain:=0.8'],
        ['-r'],
        ['-r', '__ns:=car'],
        ['-r', '__node:=/mine'],
        ['-r', 'clutch/torque:=/mine'],
        ['-r', '/clock:=clock'],
        ['-r', '/clock'],
        ['-r', '/clocks:=/car/clock'],
        ['-r', '/clutch/torque:=/other', '-r', '__ns:=/car'],
        ['-r', '/clock:=/car//clock'],
    ],
)
def test_other_ros_arguments_are_refused(arguments):
    with refused(ParameterError, '--ros-args'):
        GraphNames.of(arguments)
