# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every node takes the settings of a run, and the options of a controller only its own node."""

import pytest
from support.in_process_graph import GraphOf, by_hand
from support.runs import plan
from website.tables.parameter_tables import SHARED

from ddct_bringup.processes.graph_nodes import NODE_PROGRAMS
from ddct_plant.scenario.case import OF_CASE


@pytest.mark.parametrize('spec', NODE_PROGRAMS, ids=lambda spec: spec.name)
def test_a_node_that_controls_takes_all_settings_but_the_case(graph_of: GraphOf, spec) -> None:
    graph = graph_of(plan('pi', scenario='upshift', duration_s=2.0))
    by_hand(graph, {})  # a program gives files in place of true values
    node = graph.add(spec.name)
    declared = set(node.own_parameters())
    case = {'case', *OF_CASE}
    assert declared >= SHARED - case
    assert declared & case == (set() if node.KNOWN_ONLY else case)
    assert any(name.startswith('gains.') for name in declared) == (spec.name == 'controller')
