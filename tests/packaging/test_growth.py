# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""CONTRIBUTING shows in a few lines how something is added: those lines suffice."""

from pathlib import Path

import pytest
from message_counts import message_counts
from support.grown import SENSOR, SETTINGS, apply, output_of


@pytest.mark.graph
def test_a_sensor_is_in_the_graph_its_bag_and_the_columns(tmp_path: Path) -> None:
    pytest.importorskip('rclpy', reason='a graph')
    code = f"""{SETTINGS}
from ddct_bringup.bag.reader import read_bag
from ddct_bringup.programs.bringup import main
from ddct_bringup.scores.csv_text import signal_columns

given = [f'--set={{key}}={{value}}' for key, value in {SENSOR}.items()]
sys.argv = ['bringup', '--duration=1', '--set=score_window_s=[0.7, 1.0]', *given]
sys.argv += ['--single-process', '--out=run']
assert main() == 0
recording = read_bag(Path('run/pi'))
print(recording.trajectory.sha256() == run.sha256())
print(*(name for name in signal_columns(recording.trajectory) if 'sensed_vehicle_accel' in name))
"""
    lines = output_of(code, tmp_path, apply('A sensor', tmp_path))
    assert message_counts(tmp_path / 'run' / 'pi')['/sensors/accel'] == 101
    assert lines[-2:] == ['True', 'sensed_vehicle_accel_m_s2 sensed_vehicle_accel_held']
