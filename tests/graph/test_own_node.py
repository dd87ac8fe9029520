"""Nodes that import nothing of ours stand in for ours and give the same trajectory."""

import json
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from support.documented import ROOT
from support.processes import Programs
from support.runs import expected

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.processes.graph_nodes import GRAPH_NODES
from ddct_bringup.programs import score
from ddct_bringup.run.plan import RunPlan
from ddct_plant.graph.topics import all_signals
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

EXAMPLES = ROOT / 'docs' / 'examples'
OWN = {name: EXAMPLES / f'own_{name}.py' for name in ('controller', 'engine')}
MOST_LINES = 40
"""Of code, as the page says."""


@pytest.mark.parametrize('file', OWN.values(), ids=lambda file: file.name)
def test_an_example_is_short_and_imports_nothing_of_ours(file: Path) -> None:
    text = re.sub(r'""".*?"""', '', file.read_text(encoding='utf-8'), flags=re.DOTALL)
    assert not re.search(r'\bddct_', text)
    assert len([line for line in text.splitlines() if line.strip()]) <= MOST_LINES


def test_own_nodes_give_the_trajectory_of_ours(programs: Programs, tmp_path: Path) -> None:
    bag = tmp_path / 'own'
    parameters: dict[str, dict[str, object]] = {
        'recorder': {'out': bag},
        'driveline': {'require_recorder': True},
    }
    nodes = {}
    for node in GRAPH_NODES:
        if node.name in OWN:
            nodes[node.name] = programs.start([sys.executable, str(OWN[node.name])])
        else:
            given = {'architecture': 'base', **parameters.get(node.name, {})}
            nodes[node.name] = programs.start_node(node.module, given)
    assert nodes['driveline'].wait() == 0, nodes['driveline'].errors()
    for name in sorted(nodes, key=lambda name: name == 'recorder'):
        if name != 'driveline':
            nodes[name].stop()

    settings = RunSettings(load_scenario('thesis'), architecture='base')
    ours, own = expected(RunPlan(settings, 'pi', 'headless')), read_bag(bag)
    for signal in all_signals():
        if signal.name != 'status':
            found, wanted = (getattr(run, signal.name) for run in (own.trajectory, ours))
            assert found is wanted is None or np.array_equal(found, wanted), signal.name
    assert score.main([str(bag), '--json', str(tmp_path / 'scores.json')]) == 0
    (run,) = json.loads((tmp_path / 'scores.json').read_text())['runs']
    assert (run['controller'], run['valid'], run['metrics']['steps']) == ('own_pi', True, 300)
