"""The table of docs/use/sensors.md is what its scenario gives."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.metrics import compute_metrics
from ddct_plant.files.yaml_text import parse_yaml
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

PAGE = Path(__file__).resolve().parents[2] / 'docs' / 'use' / 'sensors.md'
SEEDS = range(1, 5)
HEAD = [
    '| sensors | controller | engagement time, s | w_sr, rpm | A_x, m/s² | slip RMSE, rpm | final '
    'slip, rpm | total variation of the request, N m |',
    '| --- | --- | --- | --- | --- | --- | --- | --- |',
]
FORMS = {
    'engagement_time_s': '.2f',
    'torsion_speed_std_rpm': '.2f',
    'acceleration_std_m_s2': '.3f',
    'slip_rmse_rpm': '.0f',
    'slip_final_rpm': '.0f',
    'torque_total_variation_n_m': '.0f',
}


def metrics(controller: str, sensors: Any, seed: int) -> dict[str, Any]:
    scenario = load_scenario('thesis', {'sensors': sensors} if sensors else {})
    computed = compute_metrics(
        run_headless(RunSettings(scenario, seed=seed), controller),
        control_start_s=scenario.control_start_s,
        score_window_s=scenario.score_window_s,
        timing=None,
    )
    return computed.as_dict()


def text(values: Sequence[float], form: str) -> str:
    low, high = (f'{value:{form}}'.replace('-', '−') for value in (min(values), max(values)))
    return low if low == high else f'{low} to {high}'


def rows(title: str, sensors: Any, seeds: Sequence[int]) -> list[str]:
    lines = []
    for controller in ('pi', 'ls8'):
        runs = [metrics(controller, sensors, seed) for seed in seeds]
        cells = [text([run[name] for run in runs], form) for name, form in FORMS.items()]
        lines.append(f'| {title} | `{controller}` | {" | ".join(cells)} |')
    return lines


def table(page: str) -> list[str]:
    block = re.search(r'```yaml\n(.*?)```', page, re.DOTALL)
    assert block is not None
    sensors = parse_yaml(block[1])['sensors']
    wrong = {**sensors, 'engine_torque': {**sensors['engine_torque'], 'gain': 1.05}}
    return [
        *HEAD,
        *rows('none', None, [0]),
        *rows('those above', sensors, SEEDS),
        *rows('and C_m 5 % too high', wrong, SEEDS),
    ]


def test_the_table_of_sensors_is_what_the_runs_give() -> None:
    page = PAGE.read_text(encoding='utf-8')
    block = re.search(r'<!-- sensors -->\n(.*?)<!-- end -->', page, re.DOTALL)
    assert block is not None
    assert block[1].splitlines() == table(page)
