# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Many runs of one warm parent: each is as if it were the only one."""

import signal
from pathlib import Path
from typing import Any

import pytest
from support.processes import processes_left
from support.runs import bag_bytes, plan
from support.shared_parent import shared_parent
from support.waiting import wait_until

from ddct_bringup.processes.jobs import Job
from ddct_bringup.processes.shared_memory import segments_of
from ddct_bringup.processes.warm_parent import WarmParent
from ddct_bringup.run.execution import execute
from ddct_bringup.run.plan import RunPlan
from ddct_plant.graph.domain import own_domain

pytestmark = pytest.mark.slow


@pytest.fixture
def parent() -> WarmParent:
    """Return the warm parent of all tests."""
    shared = shared_parent()
    assert shared is not None
    return shared


def _run(run: RunPlan, folder: Path, parent: WarmParent | None = None) -> dict[str, bytes]:
    folder.mkdir(parents=True)
    execute(run, folder, parent=parent)
    return bag_bytes(folder)


def test_runs_of_one_warm_parent_leave_the_bytes_of_headless_ones_each_in_its_domain_and_logs(
    tmp_path: Path, parent: WarmParent, monkeypatch: pytest.MonkeyPatch
) -> None:
    runs: tuple[tuple[str, dict[str, Any]], ...] = (
        ('pi', {}),
        (
            'ls8',
            {
                'wear_gain': 0.7,
                'seed': 3,
                'clutch': 'stick_slip',
                'changes': ('load.slope_rad=0.05',),
            },
        ),
        ('pi', {}),
    )
    domains = []
    monkeypatch.delenv('ROS_DOMAIN_ID')
    for number, (controller, options) in enumerate(runs):
        logs = tmp_path / f'logs{number}'
        monkeypatch.setenv('ROS_LOG_DIR', str(logs))
        with own_domain() as domain:
            warm = _run(plan(controller, **options), tmp_path / f'{number}', parent)
        alone = _run(plan(controller, 'headless', **options), tmp_path / f'{number} headless')
        assert warm == alone, (number, controller)
        assert len([*logs.iterdir()]) == 8, 'one of each node'
        domains.append(domain)
    assert len(set(domains)) == len(runs)
    _require_no_part_in_a_graph(parent)


def _require_no_part_in_a_graph(parent: WarmParent) -> None:
    tasks = Path(f'/proc/{parent.process.pid}/task').iterdir()
    names = {(task / 'comm').read_text().strip() for task in tasks}
    assert not {name for name in names if name.startswith('dds')}
    assert not segments_of(parent.process.pid)


def test_a_node_that_the_parent_of_all_tests_forked_is_found_when_it_stays(
    parent: WarmParent,
) -> None:
    (node,) = parent.start([Job('ddct_plant.nodes.load_node')])
    wait_until(lambda: 'load_node' in processes_left().get(node.pid, ''), 'the node')
    assert parent.process.pid not in processes_left()
    node.send_signal(signal.SIGKILL)
    node.wait(20.0)
    assert node.pid not in processes_left()
