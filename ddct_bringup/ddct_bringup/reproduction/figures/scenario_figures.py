# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Figures of Chapter 1 that can be computed: references, engine torque, comparison of plants."""

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from ddct_bringup.reproduction.figures.thesis_figure import ThesisFigure, draw_over_time
from ddct_bringup.reproduction.study_run import (
    THESIS_SCENARIO,
    StudyRun,
    study_run,
    thesis_run,
)
from ddct_bringup.reproduction.values.plant_values import (
    SIMPLIFIED_PLANTS,
    deviation_bound_percent,
    deviations,
    plant_slips,
)
from ddct_controllers.design.drawing.line_styles import GREY, REFERENCE_LINE, LineStyle
from ddct_plant.base.timebase import steps_in
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from ddct_plant.simplified.plants import printed_lti_slip

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LAST_S = 2.2
_SHOWN = steps_in('time shown', _LAST_S) + 1
"""Number of samples of a run up to `_LAST_S`."""
_END_TIMES_S = (1.2, 1.6, 2.0)
_PRINTED_PLANT = 'LTI, coefficients as printed'


def _reference_rpm(run: StudyRun) -> tuple[np.ndarray, np.ndarray]:
    """Return time in s, up to _LAST_S, and the slip reference of a run in rpm."""
    reference = rpm_from_rad_s(run.trajectory.at_tick('slip_reference'))
    return run.trajectory.time_s[:_SHOWN], reference[:_SHOWN]


def _tanh_run(end_s: float) -> StudyRun:
    """Return a run with the tanh reference that ends at `end_s` seconds."""
    reference = dataclasses.replace(THESIS_SCENARIO.reference, reference_end_s=end_s)
    scenario = dataclasses.replace(THESIS_SCENARIO, reference=reference)
    return study_run(RunSettings(KnownSettings(scenario, 'feedforward_tanh')), 'pi')


def _draw_reference(axes: 'Axes') -> str:
    start_s = THESIS_SCENARIO.control_start_s
    reference = _reference_rpm(thesis_run('pi', 'detailed', 1.0))
    start = np.array([start_s, start_s]), np.array([0.0, 1.0])
    to_axes = axes.get_xaxis_transform()
    across: LineStyle = {'color': GREY, 'linewidth': 1.0, 'transform': to_axes}
    draw_over_time(
        axes,
        'Slip speed reference, rpm',
        (0.0, _LAST_S),
        {'reference': reference, 'control starts': start},
        {'reference': REFERENCE_LINE, 'control starts': across},
    )
    return (
        'The shape is that of the thesis: w_d under C_fOL alone until '
        f'{start_s:g} s, then a slope to zero. It prints no values: the '
        f'peak of {np.max(reference[1]):.0f} rpm and the slope come from our calibration on Table '
        '5.1.'
    )


def _draw_engine_torque(axes: 'Axes') -> str:
    run = thesis_run('pi', 'detailed', 1.0).trajectory
    torque = run.engine_torque[:_SHOWN]
    lines = {'C_m': (run.time_s[:_SHOWN], torque)}
    draw_over_time(axes, 'Engine torque C_m, N m', (0.0, _LAST_S), lines, {})
    return (
        'The "sudden growth" in "the first 0.5 seconds" (Chapter 6) is here. The thesis prints no '
        f'values: the rise to {np.max(torque):.0f} N m is calibrated on Table 5.1.'
    )


def _draw_plants(axes: 'Axes') -> str:
    run = thesis_run('pi', 'detailed', 1.0).trajectory
    printed = {_PRINTED_PLANT: printed_lti_slip}
    slips = {
        'detailed model': run.slip_speed,
        **plant_slips({**SIMPLIFIED_PLANTS, **printed}),
    }
    draw_over_time(
        axes,
        'w_d, rpm',
        (0.0, run.time_s[-1]),
        {name: (run.time_s, rpm_from_rad_s(slip)) for name, slip in slips.items()},
        {'detailed model': {'color': '#c4c4c4', 'linewidth': 6}},
    )
    rounding = 100.0 * deviations(printed)[_PRINTED_PLANT]
    return (
        'The thesis finds all models equal. Here the three simplified ones are within '
        f'{deviation_bound_percent():g} % of the peak; the rounding of the printed coefficients '
        f'makes {rounding:.1f} %. The run is that of the PI.'
    )


def _draw_tanh(axes: 'Axes') -> str:
    lines = {
        f'tanh, zero at {end_s:.1f} s': _reference_rpm(_tanh_run(end_s)) for end_s in _END_TIMES_S
    }
    lines["CRF's"] = _reference_rpm(thesis_run('pi', 'detailed', 1.0))
    quantity = 'Slip speed reference, rpm'
    draw_over_time(axes, quantity, (0.0, _LAST_S), lines, {"CRF's": REFERENCE_LINE})
    return (
        'It goes to zero more smoothly than that of CRF, at a time that can be chosen, as the '
        'thesis says. It prints no formula: steepness and end are ours.'
    )


SCENARIO_FIGURES = (
    ThesisFigure('1.12', 'Reference signal', _draw_reference),
    ThesisFigure('1.14', 'C_m torque signal', _draw_engine_torque),
    ThesisFigure('1.23', 'Slip speed w_d of the detailed and the simplified models', _draw_plants),
    ThesisFigure('1.27', 'tanh-shaped reference', _draw_tanh),
)
