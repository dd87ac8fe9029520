# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""CONTRIBUTING shows in a few lines how something is added: those lines suffice."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
SENSOR = {'sensors.vehicle_accel.bias_m_s2': 0.5, 'sensors.vehicle_accel.dropout': 0.5}
SETTINGS = f"""
import sys
from pathlib import Path
import numpy as np
from ddct_bringup.run.headless import run_headless
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

scenario = load_scenario('thesis', {{'duration_s': 1.0, 'score_window_s': [0.7, 1.0], **{SENSOR}}})
settings = RunSettings(scenario)
run = run_headless(settings, 'pi')
"""


def diffs(title: str) -> list[str]:
    """Return the diffs of a section of the page."""
    page = (ROOT / 'CONTRIBUTING.md').read_text(encoding='utf-8')
    section = page.partition(f'### {title}\n')[2].partition('\n## ')[0].partition('\n### ')[0]
    return re.findall(r'```diff\n(.*?)```', section, re.DOTALL)


def apply(title: str, tree: Path) -> dict[str, str]:
    """Apply the diffs of a section to a copy of the sources; return the environment to run it."""
    for package in PACKAGES:
        shutil.copytree(
            ROOT / package / package,
            tree / package / package,
            ignore=shutil.ignore_patterns('__pycache__'),
        )
    (diff,) = diffs(title)
    # Outside of a repository `git apply` changes the files below the working directory.
    environment = {**os.environ, 'GIT_CEILING_DIRECTORIES': str(tree.parent)}
    subprocess.run(
        ['git', 'apply', '-'], input=diff, text=True, cwd=tree, env=environment, check=True
    )
    path = [str(tree / package) for package in PACKAGES]
    return {**environment, 'PYTHONPATH': os.pathsep.join([*path, os.environ['PYTHONPATH']])}


def output_of(code: str, tree: Path, environment: dict[str, str]) -> list[str]:
    done = subprocess.run(
        [sys.executable, '-c', code], cwd=tree, env=environment, capture_output=True, text=True
    )
    assert not done.returncode, done.stderr
    return done.stdout.splitlines()


@pytest.mark.slow
def test_a_sensor_is_one_line_for_options_and_headless_runs(tmp_path: Path) -> None:
    code = f"""{SETTINGS}
import pickle
from ddct_plant.base.options import options_of
from ddct_plant.sensors.parameters import OPTIONS

print(*options_of(OPTIONS['vehicle_accel']))
assert pickle.loads(pickle.dumps(scenario)) == scenario
received = run.sensed_vehicle_accel_held == 0.0
assert 30 < np.count_nonzero(received) < 80
assert np.array_equal(
    run.sensed_vehicle_accel[received], run.vehicle_accel[received] + 0.5
)
print(run.sensed)
"""
    (options, sensed) = output_of(code, tmp_path, apply('A sensor', tmp_path))
    assert options.split() == [
        *('gain', 'delay_s', 'dropout', 'dropout_burst'),
        *('noise_m_s2', 'quantum_m_s2', 'bias_m_s2'),
    ]
    assert sensed == 'True'


@pytest.mark.graph
def test_a_sensor_is_one_line_for_the_graph_its_bag_and_the_columns(tmp_path: Path) -> None:
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
print(recording.counts['/sensors/accel'])
print(recording.trajectory.sha256() == run.sha256())
print(*(name for name in signal_columns(recording.trajectory) if 'sensed_vehicle_accel' in name))
"""
    lines = output_of(code, tmp_path, apply('A sensor', tmp_path))
    assert lines[-3:] == ['101', 'True', 'sensed_vehicle_accel_m_s2 sensed_vehicle_accel_held']
