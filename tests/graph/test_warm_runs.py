# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Many runs of one fork server: each is as if it were the only one."""

import signal
from pathlib import Path
from typing import Any

import pytest
from support.processes import Programs, processes_left
from support.runs import bag_bytes, plan
from support.shared_memory import segments_of
from waiting import wait_until

from ddct_bringup.processes.fork_server import server_pid
from ddct_bringup.run.execution import execute
from ddct_bringup.run.plan import RunPlan
from ddct_plant.graph.domain import own_domain

pytestmark = pytest.mark.slow


def _run(run: RunPlan, folder: Path) -> dict[str, bytes]:
    folder.mkdir(parents=True)
    execute(run, folder)
    return bag_bytes(folder)


def test_runs_of_one_fork_server_leave_the_bytes_of_headless_ones_each_in_its_domain_and_logs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    runs: tuple[tuple[str, dict[str, Any]], ...] = (
        ('pi', {}),
        (
            'ls8',
            {
                'wear_gain': 0.7,
                'seed': 3,
                'scenario': 'thesis_sticking',
                'changes': ('load.slope_rad=0.05',),
            },
        ),
        ('pi', {}),
    )
    domains, servers = [], set()
    monkeypatch.delenv('ROS_DOMAIN_ID')
    for number, (controller, options) in enumerate(runs):
        logs = tmp_path / f'logs{number}'
        monkeypatch.setenv('ROS_LOG_DIR', str(logs))
        with own_domain() as domain:
            warm = _run(plan(controller, **options), tmp_path / f'{number}')
        alone = _run(plan(controller, 'headless', **options), tmp_path / f'{number} headless')
        assert warm == alone, (number, controller)
        assert len([*logs.iterdir()]) == 8, 'one of each node'
        domains.append(domain)
        servers.add(server_pid())
    assert len(set(domains)) == len(runs)
    (server,) = servers
    _require_no_part_in_a_graph(server)


def _require_no_part_in_a_graph(server: int) -> None:
    tasks = Path(f'/proc/{server}/task').iterdir()
    names = {(task / 'comm').read_text().strip() for task in tasks}
    assert not {name for name in names if name.startswith('dds')}
    assert not segments_of(server)


def test_a_node_of_the_fork_server_of_all_tests_is_found_when_it_stays(
    programs: Programs,
) -> None:
    node = programs.fork('ddct_plant.nodes.load_node')
    wait_until(lambda: 'load_node' in processes_left().get(node.process.pid, ''), 'the node')
    assert server_pid() not in processes_left()
    node.send(signal.SIGKILL)
    assert node.wait(20.0) == -signal.SIGKILL
    assert node.process.pid not in processes_left()
