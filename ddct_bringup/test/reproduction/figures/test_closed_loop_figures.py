# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Closed-loop figures of the thesis, and whether every figure is drawn or explained."""

from typing import TYPE_CHECKING

import numpy as np
import pytest
from samples import sampled
from tight_tolerance import tight_tolerance_run

from ddct_bringup.metrics.metric import Metrics
from ddct_bringup.reproduction.figures import run_figures
from ddct_bringup.reproduction.figures.command import (
    NOT_DRAWN,
    collect_figures,
)
from ddct_bringup.reproduction.figures.thesis_figure import figure_order
from ddct_bringup.reproduction.study_run import (
    THESIS_SCENARIO,
    StudyRun,
    study_run,
    thesis_run,
)
from ddct_bringup.thesis.table_5_1 import thesis_row
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

pytestmark = pytest.mark.slow

TABLE_METRICS = {figure.number: figure for figure in collect_figures()}
LS4_TO_9 = ('ls8', 'ls4', 'ls5', 'ls6', 'ls7', 'ls9')


def drawing(number: str) -> 'tuple[Figure, str]':
    """Return the chart of a figure and the remark on it."""
    return TABLE_METRICS[number].draw()


def lines(axes: 'Axes') -> dict[str, np.ndarray]:
    """Return x and y, (2, n), by label."""
    return {str(line.get_label()): np.array(line.get_data()) for line in axes.get_lines()}


@pytest.mark.parametrize(
    ('number', 'architecture', 'shown', 'unit'),
    sampled(
        [
            ('4.3', 'detailed', ('mpc3', 'mpc2', 'mpc1'), 'w_d, rpm'),
            ('2.26', 'detailed', (*LS4_TO_9, 'pi'), 'w_d, rpm'),
            ('2.15', 'feedforward', LS4_TO_9, 'w_sr, rpm'),
            ('2.22', 'feedforward_tanh', LS4_TO_9, 'A_x, m/s²'),
            ('4.8', 'detailed', ('mpc4',), 'A_x, m/s²'),
        ],
        every=2,
    ),
)
def test_run_figure_contains_the_signal_of_the_run_from_0_5_s(number, architecture, shown, unit):
    axes = drawing(number)[0].axes[0]
    run = thesis_run(shown[0], architecture, 1.0).trajectory
    signals = {
        'w_d, rpm': rpm_from_rad_s(run.slip_speed),
        'w_sr, rpm': rpm_from_rad_s(run.joint_speed[:, 3]),
        'A_x, m/s²': run.vehicle_accel,
    }
    drawn = lines(axes)[shown[0].upper()]
    np.testing.assert_array_equal(drawn, (run.time_s[50:], signals[unit][50:]))
    assert (axes.get_xlabel(), axes.get_ylabel()) == ('Time, s', unit)
    names = {name.upper() for name in shown}
    assert set(lines(axes)) == names | ({'reference'} if unit == 'w_d, rpm' else set())


def test_wear_figure_shows_hinf2_at_both_ends_of_the_wear():
    chart, _ = drawing('5.1')
    shown = lines(chart.axes[0])
    for wear in (0.7, 1.3):
        run = thesis_run('hinf2', 'feedforward', wear).trajectory
        label = f'H∞2 (K_usura = {wear:g})'
        np.testing.assert_array_equal(shown[label][1], rpm_from_rad_s(run.slip_speed[50:]))
        assert abs(shown[label][1][-1]) < 1.0


def test_the_time_axis_ends_with_the_longest_run(monkeypatch):
    """A run ends early where the engine stalls, as a controller of one's own may let it."""

    def run_of(controller: str, architecture: str, wear_gain: float) -> StudyRun:
        scenario = load_scenario('thesis', ['duration_s=1.0'] if wear_gain < 1.0 else [])
        return study_run(
            RunSettings(KnownSettings(scenario, architecture), CaseSettings(wear_gain=wear_gain)),
            controller,
        )

    monkeypatch.setattr(run_figures, 'thesis_run', run_of)
    axes = drawing('5.1')[0].axes[0]
    ends = [x[-1] for x, _ in lines(axes).values()]
    assert min(ends) == 1.0
    assert axes.get_xlim() == (0.5, max(ends)) == (0.5, THESIS_SCENARIO.duration_s)


def test_first_figure_of_a_group_has_the_verdicts_of_the_list_of_numbers():
    tracking = drawing('3.10')[1]
    assert 'Predicted hit in the list of numbers: Base: the controller that tracks' in tracking
    assert 'Predicted miss in the list of numbers: Base: w_sr of Hinf2: "huge"' in tracking
    assert '"not good", ours 2 of 9 lower in both' in drawing('2.17')[1]
    assert 'stand below Figure 2.17' in drawing('2.18')[1]


def torsion_std_rpm(controller: str, architecture: str) -> float:
    return thesis_run(controller, architecture, 1.0).metrics['torsion_speed_std_rpm']


def test_verdicts_on_the_h_infinity_figures_hold():
    by_loop = {
        architecture: [torsion_std_rpm(f'hinf{number}', architecture) for number in (1, 3, 2)]
        for architecture in ('feedforward', 'feedforward_tanh', 'detailed')
    }
    for architecture, from_slow_to_fast in by_loop.items():
        assert from_slow_to_fast == sorted(from_slow_to_fast), architecture
    assert by_loop['feedforward_tanh'][-1] == pytest.approx(
        by_loop['feedforward'][-1] / 2.0, rel=0.1
    )
    assert by_loop['detailed'] < by_loop['feedforward']


def test_verdicts_on_the_loop_shaping_figures_hold():
    lowest_rpm = {name: thesis_run(name, 'detailed', 1.0).slip_rpm.min() for name in ('ls1', 'pi')}
    assert lowest_rpm['ls1'] < -100.0 < -20.0 < lowest_rpm['pi']
    pi = torsion_std_rpm('pi', 'detailed')
    assert all(torsion_std_rpm(name, 'detailed') > pi for name in ('ls2', 'ls3', 'ls8', 'ls9'))


def metrics(controller: str) -> Metrics:
    return thesis_run(controller, 'detailed', 1.0).metrics


def test_verdicts_on_the_predictive_figures_hold():
    previous = [metrics(name) for name in ('ls8', 'hinf1')]
    for name in ('mpc1', 'mpc2', 'mpc3'):
        for other in previous:
            assert metrics(name)['slip_rmse_rpm'] < other['slip_rmse_rpm']
            assert metrics(name)['torsion_speed_std_rpm'] > other['torsion_speed_std_rpm']
            assert metrics(name)['acceleration_std_m_s2'] > other['acceleration_std_m_s2']
    mpc3, hinf1 = thesis_row('mpc3'), thesis_row('hinf1')
    assert mpc3.torsion_speed_std_rpm > hinf1.torsion_speed_std_rpm
    assert mpc3.acceleration_std_m_s2 > hinf1.acceleration_std_m_s2


def test_verdict_on_the_figures_of_mpc4_holds():
    run = thesis_run('mpc4', 'detailed', 1.0).trajectory
    controlled = rpm_from_rad_s(run.slip_speed[THESIS_SCENARIO.control_start_step :])
    assert controlled.min() > 0.0
    near = np.flatnonzero(controlled < 10.0)
    integrated = tight_tolerance_run(RunSettings(KnownSettings(THESIS_SCENARIO)), 'mpc4')['w_d']
    from_scipy = rpm_from_rad_s(integrated[THESIS_SCENARIO.control_start_step :])
    assert near[0] == np.argmax(from_scipy < 10.0)
    assert (round(1000.0 / from_scipy[0]), near[0]) == (2, 46)  # % of where it began, periods
    np.testing.assert_array_equal(np.diff(near), 1)
    times = [metrics(name)['engagement_time_s'] for name in ('ls8', 'hinf1', 'mpc3', 'pi')]
    assert min(times) > 0.46
    torsion = rpm_from_rad_s(run.joint_speed[:, 3])
    assert np.abs(torsion[np.isclose(run.time_s, 0.8).argmax() :]).max() < 0.25
    assert 'MPC4 none (for comparison MPC3 0.58)' in drawing('4.6')[1]


def test_remarks_distinguish_fitted_and_predicted_rows_of_table_5_1():
    assert drawing('2.27')[1].endswith('used in the calibration: LS8 1.15, PI 0.70.')
    assert drawing('4.4')[1].endswith('not used in the calibration: MPC3 0.90.')


def test_reference_figure_is_what_the_detailed_run_follows_once_control_starts():
    time, values = lines(drawing('1.12')[0].axes[0])['reference']
    run = thesis_run('pi', 'detailed', 1.0).trajectory
    np.testing.assert_array_equal(values, rpm_from_rad_s(run.slip_reference[: len(time), 0]))


def test_plant_figure_has_all_models_on_one_curve():
    shown = lines(drawing('1.23')[0].axes[0])
    detailed = shown.pop('detailed model')[1]
    printed = shown.pop('LTI, coefficients as printed')[1]
    assert len(shown) == 3
    for name, (_, slip) in shown.items():
        assert np.abs(slip - detailed).max() < 1e-9 * detailed.max(), name
    assert np.abs(printed - detailed).max() < 0.01 * detailed.max()


def test_tanh_figure_reaches_zero_at_the_chosen_times():
    shown = lines(drawing('1.27')[0].axes[0])
    for end_s in (1.2, 1.6, 2.0):
        time, values = shown[f'tanh, zero at {end_s:.1f} s']
        assert values[np.isclose(time, end_s)] == 0.0
        assert values[np.isclose(time, end_s - 0.01)] > 0.0


def test_every_figure_of_the_thesis_is_either_drawn_or_explained():
    counts = {1: 27, 2: 28, 3: 19, 4: 8, 5: 1}
    every = [f'{chapter}.{place + 1}' for chapter in counts for place in range(counts[chapter])]
    assert sorted([*TABLE_METRICS, *NOT_DRAWN], key=figure_order) == every
