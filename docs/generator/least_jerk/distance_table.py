# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What keeps `least_jerk` above the least peak jerk: one imperfection of the signals at a time."""

from collections.abc import Mapping
from typing import Any

from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.floor.floor import floors_of_run
from ddct_bringup.floor.values import OverFloor
from ddct_bringup.run.headless import run_headless
from ddct_controllers.least_jerk.controller import NAME
from ddct_plant.base.errors import DdctError
from ddct_plant.program.table import Table, text_or_dash
from ddct_plant.program.workers import in_processes
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

METRIC = 'peak_jerk'
LATEST_DELAY_S = 0.02
"""Largest delay of the actuator in the benchmark; the controller assumes 10 ms."""
_SCENARIOS = (
    'thesis',
    'launch',
    'launch_hot',
    'launch_gentle',
    'upshift',
    'upshift_2_3',
    'upshift_full',
    'upshift_hot',
    'upshift_light',
)
_OVER_A_RUN = 'exact, over a run near the least'
_SPEEDS = ('engine_speed', 'shaft_speed', 'vehicle_speed')


def distance_table() -> Table:
    """Return the table: a row for each scenario with floors, a column for each imperfection."""
    changes = _changes()
    cases = [(scenario, changes[name]) for scenario in _SCENARIOS for name in changes]
    with in_processes(lambda case: over_the_least(*cases[case]), len(cases)) as results:
        found = list(results)
    with in_processes(lambda index: over_a_run(_SCENARIOS[index]), len(_SCENARIOS)) as results:
        attained = list(results)
    width = len(changes)
    rows = [
        (f'`{scenario}`', *found[width * index : width * (index + 1)], attained[index])
        for index, scenario in enumerate(_SCENARIOS)
    ]
    return Table('Peak jerk over the least', ('scenario', *changes, _OVER_A_RUN), rows)


def over_the_least(scenario: str, changes: Mapping[str, Any]) -> str:
    """Return the peak jerk over the least for the same lock time, a dash where there is none."""
    over = _over_floor(scenario, changes, attain=False)
    return text_or_dash(over.over_floor if over else None, '.2f')


def over_a_run(scenario: str) -> str:
    """Return the peak jerk over that of a run near the least, with exact signals; or a dash."""
    over = _over_floor(scenario, {}, attain=True)
    attained = over.floor.attained if over else None
    return text_or_dash(over.value / attained if over and attained else None, '.2f')


def _over_floor(scenario: str, changes: Mapping[str, Any], *, attain: bool) -> OverFloor | None:
    made = load_scenario(scenario, changes, clutch='stick_slip')
    settings = RunSettings(made, clutch='stick_slip', seed=1)
    run = run_headless(settings, NAME)
    try:
        return floors_of_run(settings, [METRIC], run, attain=attain)[METRIC]
    except DdctError:
        return None


def _changes() -> dict[str, dict[str, Any]]:
    """Return changes of a scenario by the headings of their columns."""
    (sensors,) = Cases.packaged().content['grid']['sensors']

    def parts(names: tuple[str, ...], *keys: str) -> dict[str, Any]:
        chosen = {
            name: {key: value for key, value in sensors[name].items() if key in keys}
            for name in names
        }
        return {'sensors': chosen}

    noise = 'noise_rad_s', 'noise_n_m', 'quantum_rad_s', 'quantum_m_s', 'quantum_n_m', 'dropout'
    return {
        'exact': {},
        'noise of C_m': parts(('engine_torque',), *noise),
        'noise of speeds': parts(_SPEEDS, *noise),
        'late sensors': parts((*_SPEEDS, 'engine_torque'), 'delay_s'),
        'late actuator': {'actuator.delay_s': LATEST_DELAY_S},
        'all of it': {'sensors': sensors, 'actuator.delay_s': LATEST_DELAY_S},
    }
