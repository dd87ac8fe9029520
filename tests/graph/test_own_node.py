# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Nodes that import none of this project's code replace its nodes and give the same trajectory."""

import re
import runpy
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rclpy
from support.documented import ROOT, blocks
from support.in_process_graph import GraphOf
from support.runs import plan
from waiting import WITHIN_S

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.run.headless import run_headless
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from ddct_plant.signals.topics import TORQUE_PARTS, all_signals

PAGE = 'docs/develop/graph.md'
EXAMPLES = sorted((ROOT / 'docs' / 'examples').glob('own_*.py'))
MOST_LINES = 50
"""Largest number of lines of code of an example, as on the page; comments are none."""
_KILLED_AT_EXIT = "trap 'kill -KILL $(jobs -p) 2>/dev/null || true; wait' EXIT"
"""An example may hang as it leaves the graph: no supervisor ends it, as it ends a node of ours."""


@pytest.mark.parametrize('file', EXAMPLES, ids=lambda file: file.name)
def test_an_example_is_short_and_imports_nothing_of_ours(file: Path) -> None:
    text = re.sub(r'""".*?"""', '', file.read_text(encoding='utf-8'), flags=re.DOTALL)
    assert not re.search(r'\bddct_', text)
    code = [line for line in text.splitlines() if line.strip() and not line.startswith('#')]
    assert len(code) <= MOST_LINES


def test_the_page_shows_the_examples_as_they_run() -> None:
    shown = [block for block in blocks() if (block.page, block.language) == (PAGE, 'python')]
    for block, name in zip(shown, ('own_controller.py', 'own_actuator.py'), strict=True):
        assert block.text in (ROOT / 'docs' / 'examples' / name).read_text(encoding='utf-8')


def test_own_nodes_give_the_trajectory_of_ours_by_the_lines_of_the_page(tmp_path: Path) -> None:
    shown = [block.text for block in blocks() if block.page == PAGE]
    (commands,) = [text for text in shown if 'own_controller.py' in text and 'own_engine' in text]
    for name, target in (('docs', ROOT / 'docs'), ('install', ROOT / 'install')):
        (tmp_path / name).symlink_to(target)
    (tmp_path / '.venv').symlink_to(sys.prefix)
    done = subprocess.run(
        ['bash', '-ec', f'{_KILLED_AT_EXIT}\n{commands}'],
        cwd=tmp_path,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=WITHIN_S,
    )
    assert done.returncode == 0, done.stderr
    assert re.search(r'own_pi .* engaged *$', done.stdout, re.MULTILINE), 'and valid'

    gains = ('proportional_gain=0.2', 'integral_gain=0.6')
    scenario = load_scenario('thesis', [f'controllers.pi.{gain}' for gain in gains])
    ours = run_headless(RunSettings(KnownSettings(scenario, architecture='base')), 'pi')
    own = read_bag(tmp_path / 'runs' / 'own').trajectory
    for signal in all_signals():
        found, wanted = (getattr(run, signal.name) for run in (own, ours))
        if signal in TORQUE_PARTS.signals:
            assert found is None, 'the node leaves the parts out'
        elif signal.name != 'status':
            assert found is wanted is None or np.array_equal(found, wanted), signal.name


@pytest.mark.parametrize('mode', ['lockstep', 'realtime'])
def test_the_actuator_carries_the_run_and_in_real_time_opens_when_requests_stop(
    graph_of: GraphOf, monkeypatch: pytest.MonkeyPatch, mode: str
) -> None:
    graph = graph_of(plan(mode=mode))
    monkeypatch.setattr(rclpy.node, 'get_default_context', lambda: graph.context)
    monkeypatch.setattr(rclpy, 'init', lambda: None)
    monkeypatch.setattr(rclpy, 'spin', graph.add_other)
    runpy.run_path(str(ROOT / 'docs' / 'examples' / 'own_actuator.py'))
    graph.add_all(without=['actuator'])
    recorder: Any = graph.nodes['recorder']
    if mode == 'realtime':
        graph.spin_until(lambda: recorder._bag.steps >= 60, 'a step with a torque')
        graph.remove('controller')
    graph.run()
    torque = read_bag(graph.folder).trajectory.actuator_torque
    if mode == 'realtime':
        assert torque[60, 0] > 200.0
        assert torque[-1, -1] == 0.0
        assert np.diff(torque[:, 0]).min() == pytest.approx(-10.0)
    else:
        assert torque[1:, 0] == pytest.approx(torque[:-1, -1]), 'continuous'
        assert torque[-1, -1] > 200.0
