# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of `least_jerk`: development cases, ingredients, and its row beside Table 5.1."""

from collections.abc import Mapping, Sequence

from ddct_bringup.benchmark.cases import Cases, packaged_folder
from ddct_bringup.benchmark.release import release_rows
from ddct_bringup.reproduction.study_run import thesis_run
from ddct_bringup.run.headless import run_headless
from ddct_bringup.thesis.table_5_1 import ROW_OF, TABLE_METRICS
from ddct_bringup.verdict.state import ENGAGED
from ddct_bringup.verdict.verdict import Verdict
from ddct_controllers.least_jerk.controller import NAME
from ddct_plant.program.table import Table
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings
from generator.least_jerk.distance_table import distance_table
from generator.least_jerk.price_of_limits import price_table
from generator.least_jerk.repeated_cases import handover_table, parted_table, scored
from generator.least_jerk.variants import Variant
from generator.runs.benchmark_tables import CASE_HEADERS, case_cells

SCENARIOS = (
    *('launch', 'launch_hill', 'launch_gentle', 'thesis'),
    *('upshift', 'upshift_light', 'tip_in'),
)
WEAR_GAINS = (0.7, 1.0, 1.3)
DELAY_S = 0.015
"""Delay of the actuator in the runs without an ingredient; the controller assumes 10 ms."""
SHIFT = 'upshift'
"""Scenario with a column for its weighted acceleration."""
RELEASES, PEAK_JERK, WEIGHTED = 'releases_after_lock', 'peak_jerk', 'weighted_acceleration'
_HEADERS = (
    *('without', 'engaged runs', 'releases', *(f'`{name}`' for name in SCENARIOS)),
    f'`{SHIFT}`, weighted',
)
_CASE_HEADERS = ('scenario', *CASE_HEADERS)
_ROW_HEADERS = ('controller', 't_a s', 'std w_sr rpm', 'std A_x m/s^2')
_FORMS = ('.2f', '.2f', '.3f')


VARIANTS = (
    Variant('nothing: all of it'),
    Variant(
        'the estimate of the wear',
        {'gain_drift': 0.0, 'offset_drift_n_m': 0.0},
        {'INITIAL_GAIN': 0.0, 'INITIAL_OFFSET_N_M': 0.0},
    ),
    Variant('the low-pass of that estimate', {}, {'APPLIED_SHARE': 1.0}),
    Variant('the prediction over the lag of the actuator', {}, {'AHEAD': 0, 'LAG_S': 0.0}),
    Variant('more time than the reference gives', {'latest_s': 0.0}),
    Variant(
        'more time for a small slip',
        {'least_s': 0.0, 'shift_s': 0.0},
    ),
    Variant('the faster rise after a torque phase', {'refill_s': 10.0}),
    Variant('the low-pass of the planned torque', {'smoothing_s': 0.0}),
    Variant('the trend of the demand, but for its last values', {}, {'LONGEST': 12}),
    Variant('the slow correction of the way down', {}, {'CORRECTION': 1e9}),
    Variant('most of the correction by the measured slip', {'observer_rad_s': 0.5}),
    Variant('the filter of the measured slip', {'observer_rad_s': 30.0}),
    Variant('the engine torque after the demand', {'demand_periods': 0.0}),
)
"""Variants in the order of the table."""


def least_jerk_tables() -> Mapping[str, Table]:
    """Return the tables of the page by name."""
    rows = [_row(variant) for variant in VARIANTS]
    return {
        'development': Table('Development cases', _CASE_HEADERS, development_rows()),
        'unavoidable': parted_table(),
        'handovers': handover_table(),
        'distance': distance_table(),
        'price': price_table(),
        'ingredients': Table('What each ingredient brings', _HEADERS, rows),
        'table_5_1': Table('Beside Table 5.1', _ROW_HEADERS, list(_table_5_1())),
    }


def development_rows() -> list[tuple[str, ...]]:
    """Return a row for each scenario, from the rows that the release has."""
    rows = release_rows(packaged_folder()).rows.of(NAME)
    scenarios = dict.fromkeys(rows['scenario'].tolist())
    return [
        (
            f'`{name}`',
            *case_cells({key: column[rows['scenario'] == name] for key, column in rows.items()}),
        )
        for name in scenarios
    ]


def _row(variant: Variant) -> tuple[str, ...]:
    with variant.constants_changed():
        found = {name: _verdicts(name, variant) for name in SCENARIOS}
    runs = [run for runs in found.values() for run in runs]
    releases = sum(run.values[RELEASES] or 0.0 for run in runs)
    return (
        variant.label,
        f'{sum(run.state == ENGAGED for run in runs)} of {len(runs)}',
        f'{releases:.0f}',
        *(f'{_highest(each, PEAK_JERK):.1f}' for each in found.values()),
        f'{_highest(found[SHIFT], WEIGHTED):.3f}',
    )


def _highest(runs: Sequence[Verdict], criterion: str) -> float:
    return max(run.values[criterion] or 0.0 for run in runs)


def _verdicts(name: str, variant: Variant) -> list[Verdict]:
    """Return those of runs with the sensors of the benchmark, one for each wear gain."""
    (sensors,) = Cases.packaged().content['grid']['sensors']
    changes = {'sensors': sensors, 'actuator.delay_s': DELAY_S, **variant.changes}
    scenario = load_scenario(name, changes, 'stick_slip')
    worn = [
        RunSettings(scenario, clutch='stick_slip', wear_gain=gain, seed=1) for gain in WEAR_GAINS
    ]
    return [scored(settings, run_headless(settings, NAME)).verdict for settings in worn]


def _table_5_1() -> Sequence[tuple[str, ...]]:
    """Return the printed rows, then that of `least_jerk` with the linear clutch."""
    printed = [(row.label, *row.cells()) for row in ROW_OF.values()]
    values = (thesis_run(NAME, 'detailed', 1.0).metrics[name] for name in TABLE_METRICS)
    cells = (
        '-' if value is None else format(value, form)
        for value, form in zip(values, _FORMS, strict=True)
    )
    return [*printed, (f'`{NAME}`, linear clutch', *cells)]
