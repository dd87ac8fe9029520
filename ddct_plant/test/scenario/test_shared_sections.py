# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Scenarios of one file share what they do not change, and equal those that are built alone."""

from typing import Any

from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.models import parameters
from ddct_plant.scenario.file import ScenarioFile, load_scenario
from ddct_plant.scenario.rules import driveline
from ddct_plant.scenario.rules.driveline import require_driveline

CHANGES: tuple[dict[str, Any], ...] = (
    {},
    {'vehicle.mass_kg': 1200.0},
    {'driveline': {'engine_inertia': 0.3}},
    {'driveline.engine_inertia': 0.3},
    {'engine': {'time_s': [0.0], 'torque_n_m': [70.0]}},
    {'engine.factor': 0.5},
    {'control_start_s': 0.8},
    {},
)


def test_every_scenario_of_a_file_equals_that_of_the_file_read_anew() -> None:
    file = ScenarioFile.read('thesis')
    for changes in CHANGES:
        assert file.scenario(changes) == load_scenario('thesis', changes)


def test_a_section_of_the_file_that_does_not_change_is_built_once() -> None:
    file = ScenarioFile.read('thesis')
    first, second = (file.scenario({'vehicle.mass_kg': mass}) for mass in (1200.0, 1300.0))
    assert first.engine is second.engine
    assert first.vehicle.mass_kg != second.vehicle.mass_kg


def test_a_bad_value_is_refused_after_good_ones_with_its_key() -> None:
    file = ScenarioFile.read('thesis')
    file.scenario({'vehicle.mass_kg': 1200.0})
    for bad in (-1.0, float('nan'), float('inf'), True, 'heavy'):
        with refused(ParameterError, 'vehicle.mass_kg', place='scenario thesis'):
            file.scenario({'vehicle.mass_kg': bad})


def test_a_driveline_of_usual_magnitudes_needs_no_matrices(monkeypatch) -> None:
    built: list[object] = []
    monkeypatch.setattr(driveline, 'one_clutch_system', built.append)
    require_driveline(parameters.DrivelineParameters(), 'linear')
    assert built == []
    require_driveline(parameters.DrivelineParameters(vehicle_inertia=1e-15), 'linear')
    assert len(built) == 1
