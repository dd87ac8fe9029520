# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Effect of the sensors of docs/use/sensors.md in the scenario `thesis`, over a few seeds."""

import re
from collections.abc import Sequence
from typing import Any

from ddct_bringup.metrics.values import compute_metrics
from ddct_bringup.run.headless import run_headless
from ddct_plant.files.yaml_text import parse_yaml
from ddct_plant.program.table import Table
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings
from generator.pages import DOCS

PAGE = DOCS / 'use' / 'sensors.md'
SEEDS = range(1, 5)
CONTROLLERS = ('pi', 'ls8')
_COLUMNS = {
    'engagement time s': ('engagement_time_s', '.2f'),
    'w_sr rpm': ('torsion_speed_std_rpm', '.2f'),
    'A_x m/s²': ('acceleration_std_m_s2', '.3f'),
    'slip RMSE rpm': ('slip_rmse_rpm', '.0f'),
    'final slip rpm': ('slip_final_rpm', '.0f'),
    'request, total variation N m': ('torque_total_variation_n_m', '.0f'),
}


def sensor_table() -> Table:
    """Return a row for each set of sensors and controller; the page has the sensors."""
    block = re.search(r'```yaml\n(.*?)```', PAGE.read_text(encoding='utf-8'), re.DOTALL)
    assert block is not None
    sensors = parse_yaml(block[1])['sensors']
    wrong = {**sensors, 'engine_torque': {**sensors['engine_torque'], 'gain': 1.05}}
    sets: tuple[tuple[str, dict[str, Any], Sequence[int]], ...] = (
        ('none', {}, (0,)),
        ('those above', {'sensors': sensors}, SEEDS),
        ('also C_m 5 % too high', {'sensors': wrong}, SEEDS),
    )
    rows = [
        _row(title, changes, seeds, controller)
        for title, changes, seeds in sets
        for controller in CONTROLLERS
    ]
    return Table('Sensors in thesis', ('sensors', 'controller', *_COLUMNS), rows)


def _row(
    title: str, changes: dict[str, Any], seeds: Sequence[int], controller: str
) -> tuple[str, ...]:
    scenario = load_scenario('thesis', changes)
    runs = [
        compute_metrics(
            run_headless(RunSettings(scenario, seed=seed), controller),
            control_start_s=scenario.control_start_s,
            score_window_s=scenario.score_window_s,
            timing=None,
        )
        for seed in seeds
    ]
    cells = [_range([run[key] for run in runs], form) for key, form in _COLUMNS.values()]
    return (title, f'`{controller}`', *cells)


def _range(values: Sequence[Any], form: str) -> str:
    low, high = (f'{value:{form}}'.replace('-', '−') for value in (min(values), max(values)))
    return low if low == high else f'{low} to {high}'
