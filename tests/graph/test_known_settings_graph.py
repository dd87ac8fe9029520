# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The control nodes of a graph have the known settings alone, and the run is as headless."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from received import (
    UNKNOWN,
    UNKNOWN_IN_A_SHIFT,
    found_in,
    keeper_file,
    settings_with,
    true_values,
)
from support.runs import LAYOUTS, bag_bytes, expected, record

from ddct_bringup.run.plan import RunPlan
from ddct_plant.graph.node_reports import run_info_pairs

SENSORS = {'engine_speed': {'noise_rad_s': 0.1}}
CONTROL = ('controller', 'reference', 'handover')


@pytest.mark.slow
@pytest.mark.parametrize(
    ('scenario', 'varied'),
    [
        ('thesis', {'wear_gain': 2.0, 'seed': 5, 'vehicle.mass_kg': 1800.0, 'sensors': SENSORS}),
        ('upshift', {**UNKNOWN_IN_A_SHIFT, 'sensors': SENSORS}),
    ],
)
def test_every_layout_leaves_the_same_bytes_with_settings_that_control_nodes_do_not_know(
    tmp_path: Path, scenario: str, varied: dict[str, Any]
) -> None:
    settings = settings_with(varied, scenario, duration_s=1.0)
    bags = []
    for layout in LAYOUTS:
        run = RunPlan(settings, 'mpc_preview', layout)
        recording = record(run, tmp_path / layout)
        assert recording.settings == settings
        assert recording.trajectory.sha256() == expected(run).sha256(), layout
        bags.append(bag_bytes(tmp_path / layout))
    assert all(bag == bags[0] for bag in bags)
    ours = {node.strip('/'): pairs for node, pairs in recording.run_info.items()}
    known, true = run_info_pairs(settings.known), run_info_pairs(settings)
    for node, pairs in ours.items():
        expected_pairs = known if node in CONTROL else true
        assert expected_pairs.items() <= pairs.items(), node
    assert not found_in([ours[node] for node in CONTROL if node in ours], true_values(settings))


@pytest.mark.parametrize(
    ('scenario', 'varied'), [('launch', UNKNOWN), ('upshift', UNKNOWN_IN_A_SHIFT)]
)
def test_control_nodes_find_no_true_value_in_their_parameters_and_objects(
    tmp_path: Path, graph_of: Callable[..., Any], scenario: str, varied: dict[str, Any]
) -> None:
    settings = settings_with(varied, scenario, duration_s=0.5)
    values = true_values(settings)
    file, kept = keeper_file(tmp_path)
    graph = graph_of(RunPlan(settings, file, 'single-process'))
    graph.add_all()
    graph.run()
    assert kept[-1].measurements
    assert not found_in(kept, values)
    for name in CONTROL:
        node = graph.nodes.get(name)
        if node is None:
            continue
        given = {each: node.get_parameter(each).value for each in node.own_parameters()}
        given |= {each: of.value for each, of in node._parameter_overrides.items()}
        assert not {'wear_gain', 'seed', 'off_going_wear_gain', 'known_scenario'} & given.keys()
        assert not found_in([given, node.settings], values)
        written = Path(given['scenario']).read_text(encoding='utf-8')
        assert not found_in(written, values)
    parameters = [each.value for each in graph.nodes['clutch']._parameter_overrides.values()]
    assert settings.wear_gain in found_in(parameters, values)
