# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Forks have what the fork server has imported, and are new in all else."""

from pathlib import Path

import pytest
from stub_programs import Start

from ddct_bringup.run import description
from ddct_bringup.run.description import commit_of
from ddct_plant.graph.domain import own_domain

pytestmark = pytest.mark.process


def test_two_forks_draw_other_random_numbers(run: Start) -> None:
    text = (
        'import random\n'
        'from numpy import random as others\n'
        'def main(): print(random.random(), others.random(), others.default_rng().random())\n'
    )
    first, second = (run(text).printed_text().split() for _ in range(2))
    assert all(one != other for one, other in zip(first, second, strict=True))


def test_a_fork_knows_the_commit_of_the_sources_without_git(run: Start) -> None:
    pytest.importorskip('rclpy')
    text = (
        'import os\n'
        'from ddct_bringup.run.description import source_commit\n'
        'def main():\n'
        '    os.environ["PATH"] = "/nowhere"\n'
        '    print(source_commit())\n'
    )
    assert run(text).lines() == [commit_of(Path(description.__file__))]


def test_a_node_imports_no_generator_of_messages_and_can_import_all_of_it(
    run: Start, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip('rclpy')
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    with own_domain():
        forked = run(
            'import sys, rclpy\n'
            'def main():\n'
            '    rclpy.init()\n'
            '    rclpy.create_node("alone").destroy_node()\n'
            '    print({"em", "lark", "rosidl_generator_py"} & set(sys.modules))\n'
            '    rclpy.shutdown()\n'
            '    from rosidl_generator_py import generate_py\n'
            '    print(generate_py.__name__)\n'
        )
    assert forked.lines() == ['set()', 'generate_py']


def test_the_fork_server_has_imported_the_nodes_and_no_thread_of_python(run: Start) -> None:
    pytest.importorskip('rclpy')
    text = (
        'import sys, threading\n'
        'MODULES = ("rclpy", "ddct_bringup.record.recorder_node", "scipy.linalg")\n'
        'BEFORE = [name for name in MODULES if name in sys.modules]\n'
        'def main(): print(*BEFORE, threading.active_count())\n'
    )
    names = 'rclpy ddct_bringup.record.recorder_node scipy.linalg'
    # The second thread is ours: it waits for the end of the program.
    assert run(text).lines() == [f'{names} 2']
