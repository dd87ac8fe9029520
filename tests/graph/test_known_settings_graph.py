# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The control nodes of a graph have the known settings alone, and the run is as headless."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from received import (
    UNKNOWN,
    UNKNOWN_IN_A_SHIFT,
    files_named_in,
    found_in,
    keeper_file,
    settings_with,
    spy_file,
    true_values,
)
from support.runs import LAYOUTS, bag_bytes, expected, record

from ddct_bringup.processes.graph_nodes import nodes_of
from ddct_bringup.run.plan import RunPlan
from ddct_plant.scenario.recorded_settings import settings_of_bag

SENSORS = {'engine_speed': {'noise_rad_s': 0.1}}
CONTROL = ('controller', 'reference', 'handover')


@pytest.mark.slow
@pytest.mark.parametrize(
    ('scenario', 'varied'),
    [
        pytest.param(
            'thesis',
            {'wear_gain': 2.0625, 'seed': 424243, 'vehicle.mass_kg': 1800.0, 'sensors': SENSORS},
            marks=pytest.mark.nightly,
        ),
        ('upshift', {**UNKNOWN_IN_A_SHIFT, 'sensors': SENSORS}),
    ],
)
def test_every_layout_leaves_the_same_bytes_with_settings_that_control_nodes_do_not_know(
    tmp_path: Path, scenario: str, varied: dict[str, Any]
) -> None:
    settings = settings_with(varied, scenario, duration_s=0.6)
    bags = []
    for layout in LAYOUTS:
        run = RunPlan(settings, 'mpc_preview', layout)
        recording = record(run, tmp_path / layout)
        assert recording.settings == settings
        assert recording.trajectory.sha256() == expected(run).sha256(), layout
        bags.append(bag_bytes(tmp_path / layout))
    assert all(bag == bags[0] for bag in bags)
    values = true_values(settings)
    recorded = settings_of_bag(recording.custom_data)
    assert not found_in([recording.run_info, recorded.known], values)
    of_case = [value for value in values if value in found_in(recorded.case, values)]
    assert of_case == values, 'the rest of the settings is in the case alone'


@pytest.mark.parametrize(
    ('scenario', 'varied'), [('launch', UNKNOWN), ('upshift', UNKNOWN_IN_A_SHIFT)]
)
def test_control_nodes_find_no_true_value_in_their_parameters_and_objects(
    tmp_path: Path,
    graph_of: Callable[..., Any],
    capfd: pytest.CaptureFixture[str],
    scenario: str,
    varied: dict[str, Any],
) -> None:
    settings = settings_with(varied, scenario, duration_s=0.5)
    values = true_values(settings)
    file, kept = keeper_file(tmp_path)
    graph = graph_of(RunPlan(settings, file, 'single-process'))
    graph.add_all()
    graph.run()
    assert not found_in(capfd.readouterr().err, values), 'what nodes log is on /rosout too'
    assert kept[-1].measurements
    assert not found_in(kept, values)
    for name in CONTROL:
        node = graph.nodes.get(name)
        if node is None:
            continue
        given = {each: node.get_parameter(each).value for each in node.own_parameters()}
        given |= {each: of.value for each, of in node._parameter_overrides.items()}
        assert not {'case', 'wear_gain', 'seed', 'off_going_wear_gain'} & given.keys()
        assert not found_in([given, node.known, node._true], values)
        written = Path(given['known']).read_text(encoding='utf-8')
        assert not found_in(written, values)
    assert graph.nodes['clutch'].settings == settings
    for node in graph.nodes.values():
        parameters = node.get_parameters(node.own_parameters())
        assert not found_in([each.value for each in parameters], values), node.get_name()


@pytest.mark.nightly
def test_a_controller_in_a_process_of_its_own_finds_no_value_of_the_case(tmp_path: Path) -> None:
    settings = settings_with(UNKNOWN_IN_A_SHIFT, 'upshift', duration_s=0.5)
    values = true_values(settings)
    file, found = spy_file(tmp_path, values)
    record(RunPlan(settings, file, 'processes'), tmp_path / 'run')
    notes = found.read_text(encoding='utf-8').splitlines()
    assert set(notes) == {'made []', 'held []', 'updated []'}


def test_a_control_process_can_name_no_file_with_a_true_value(tmp_path: Path) -> None:
    settings = settings_with(UNKNOWN_IN_A_SHIFT, 'upshift', duration_s=0.5)
    values = true_values(settings)
    arguments = RunPlan(settings, 'pi', 'processes').write_parameter_files(tmp_path, tmp_path)
    for node in nodes_of(shift=True):
        given = arguments.of(node)
        file = given[given.index('--params-file') + 1]
        named = files_named_in(Path(file))
        texts = [each.read_text(encoding='utf-8') for each in named]
        expected = [] if node.path in CONTROL else values
        assert sorted(found_in(texts, values)) == sorted(expected), node.path
        assert len(named) == (2 if node.path in CONTROL else 3)
        beside = [each.read_text(encoding='utf-8') for each in Path(file).parent.iterdir()]
        assert node.path not in CONTROL or not found_in(beside, values)


def test_case_and_known_settings_are_in_the_parameters_of_the_nodes_that_have_them(
    tmp_path: Path,
) -> None:
    settings = settings_with(UNKNOWN_IN_A_SHIFT, 'upshift', duration_s=0.5)
    arguments = RunPlan(settings, 'pi', 'processes').write_parameter_files(tmp_path, tmp_path)
    of_case = {
        node
        for file in (arguments.control, arguments.plant)
        for node, each in yaml.safe_load(file.read_text(encoding='utf-8')).items()
        if 'case' in each['ros__parameters']
    }
    assert of_case == {
        f'/**/{node.path}' for node in nodes_of(shift=True) if node.path not in CONTROL
    }
