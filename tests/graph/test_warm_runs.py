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


def test_the_runs_of_one_warm_parent_leave_the_same_bytes_as_runs_without_a_graph(
    tmp_path: Path, parent: WarmParent
) -> None:
    runs: tuple[tuple[str, dict[str, Any]], ...] = (
        ('pi', {}),
        ('ls8', {'wear_gain': 0.7, 'seed': 3, 'changes': ('load.slope_rad=0.05',)}),
        ('mpc4', {'clutch': 'stick_slip'}),
        ('pi', {}),
    )
    for number, (controller, options) in enumerate(runs):
        warm = _run(plan(controller, **options), tmp_path / f'{number}', parent)
        alone = _run(plan(controller, 'headless', **options), tmp_path / f'{number} headless')
        assert warm == alone, (number, controller)


def test_the_warm_parent_itself_never_joins_a_graph(tmp_path: Path, parent: WarmParent) -> None:
    _run(plan(), tmp_path / 'run', parent)
    tasks = Path(f'/proc/{parent.process.pid}/task').iterdir()
    names = {(task / 'comm').read_text().strip() for task in tasks}
    assert not {name for name in names if name.startswith('dds')}
    assert not segments_of(parent.process.pid)


def test_each_run_has_its_own_domain_and_folder_of_logs(
    tmp_path: Path, parent: WarmParent, monkeypatch: pytest.MonkeyPatch
) -> None:
    logs, domains = [], []
    monkeypatch.delenv('ROS_DOMAIN_ID')
    for number in range(2):
        monkeypatch.setenv('ROS_LOG_DIR', str(tmp_path / f'logs{number}'))
        with own_domain() as domain:
            _run(plan(), tmp_path / f'run{number}', parent)
        domains.append(domain)
        logs.append(sorted((tmp_path / f'logs{number}').iterdir()))
    assert domains[0] != domains[1]
    assert [len(each) for each in logs] == [8, 8], 'one of each node'


def test_a_node_that_the_parent_of_all_tests_forked_is_found_when_it_stays(
    parent: WarmParent,
) -> None:
    (node,) = parent.start([Job('ddct_plant.nodes.load_node')])
    wait_until(lambda: 'load_node' in processes_left().get(node.pid, ''), 'the node')
    assert parent.process.pid not in processes_left()
    node.send_signal(signal.SIGKILL)
    node.wait(20.0)
    assert node.pid not in processes_left()
