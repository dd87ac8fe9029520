# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page of each package names the topics and parameters of its nodes, as they declare them."""

import re

import pytest
from generator.pages import as_markdown, rows_of, shown_tables
from generator.parameter_tables import SHARED, parameter_tables
from support.documented import package_page
from support.in_process_graph import GraphOf, by_hand
from support.runs import plan

from ddct_bringup.processes.graph_nodes import NODE_PROGRAMS, nodes_of
from ddct_plant.scenario.case import OF_CASE

OF_ROS = {'/rosout', '/parameter_events', '/run_info'}
WITH_TARGET = (
    'reference.shape=engine_speed_target',
    'engine_speed_reference={time_s: [0.0, 2.0], speed_rad_s: [160.0, 180.0]}',
)
SHIFT = plan('pi', scenario='upshift', duration_s=2.0)
RUNS = (
    plan('pi'),
    plan('pi', scenario='thesis_sticking', changes=('sensors={}',)),
    plan('mpc4'),
    plan('pi', mode='realtime'),
    plan('pi', changes=WITH_TARGET),
    plan('pi', changes=(*WITH_TARGET, 'sensors={}')),
    SHIFT,
    plan('mpc4', scenario='upshift', duration_s=2.0, changes=('sensors={}',)),
)
"""Runs that have every topic between them."""


def cells(package: str, node: str) -> list[set[str]]:
    """Return the names in the cells of a node's row: topics read, published."""
    nodes = package_page(package).partition('<!-- parameters')[0]
    (row,) = re.findall(rf'^\| `{node}` \|(.*)\|$', nodes, re.MULTILINE)
    return [set(re.findall(r'`([^`]+)`', cell)) for cell in row.split('|')]


@pytest.mark.parametrize('spec', NODE_PROGRAMS, ids=lambda spec: spec.name)
def test_the_row_of_a_node_is_what_it_declares(graph_of: GraphOf, spec) -> None:
    read: set[str] = set()
    published: set[str] = set()
    for run in RUNS:
        if spec not in nodes_of(shift=run.settings.shift):
            continue
        node = graph_of(run).add(spec.name)
        read |= {each.topic_name for each in node.subscriptions}
        published |= {each.topic_name for each in node.publishers}
    rows = cells(spec.module.split('.')[0], spec.name)
    topics = [{f'/{name.removeprefix("/")}' for name in row} for row in rows[:2]]
    if spec.name != 'recorder':
        assert topics[0] == read - OF_ROS
    assert topics[1] == published - OF_ROS


def test_the_tables_of_parameters_are_what_the_nodes_declare() -> None:
    shown = shown_tables('parameters')
    assert shown == as_markdown(parameter_tables()), 'run: make docs KINDS=parameters'
    for spec in NODE_PROGRAMS:
        marked = f'<!-- parameters: {spec.name} -->' in package_page(spec.module.split('.')[0])
        assert marked == (spec.name in shown)


def test_shared_parameters_and_those_of_its_own_are_all_that_a_node_declares(
    graph_of: GraphOf,
) -> None:
    tables = shown_tables('parameters')
    graph = graph_of(SHIFT)
    by_hand(graph, {})  # a program gives files in place of true values
    for spec in NODE_PROGRAMS:
        shown = {row[0].strip('`') for row in rows_of(tables.get(spec.name, ''))}
        node = graph.add(spec.name)
        case = {'case', *OF_CASE}
        shared = SHARED - case if node.KNOWN_ONLY else SHARED
        declared = set(node.own_parameters())
        gains = {name for name in declared if name.startswith('gains.')}
        assert bool(gains) == (spec.name == 'controller')
        assert declared - gains == shared | shown
