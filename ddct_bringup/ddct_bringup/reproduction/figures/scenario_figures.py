"""Figures of Chapter 1 that can be computed: references, engine torque, plants that agree."""

import dataclasses
import math
from collections.abc import Mapping

import numpy as np

from ddct_bringup.reproduction.figures.thesis_figure import Drawing, ThesisFigure
from ddct_bringup.reproduction.runs.runs import THESIS_SCENARIO, thesis_run
from ddct_controllers.design.drawing.chart_style import (
    GREY,
    REFERENCE_LINE,
    line_styles,
    new_chart,
)
from ddct_controllers.design.drawing.charts import label_time_axis
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.models.engine import Engine
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.simplified.elementary import ElementaryBlockPlant
from ddct_plant.simplified.plants import (
    SimplifiedPlant,
    StateSpacePlant,
    lti_plant,
    printed_lti_plant,
)
from ddct_reference.factory import make_reference

_LAST_S = 2.2
_END_TIMES_S = (1.2, 1.6, 2.0)
_PRINTED_PLANT = 'LTI, coefficients as printed'


def reference_rpm(scenario: Scenario, architecture: str) -> tuple[np.ndarray, np.ndarray]:
    """Return time in s and the stored slip reference in rpm of an architecture without C_fOL."""
    reference = make_reference(RunSettings(scenario, architecture))
    steps = np.arange(round(_LAST_S / PERIOD_S) + 1)
    speeds = [reference.update(int(step), 0.0)[0][0] for step in steps]
    return steps * PERIOD_S, rpm_from_rad_s(np.array(speeds))


def tanh_scenario(end_s: float) -> Scenario:
    """Return the thesis's scenario with a tanh reference that ends at `end_s` seconds."""
    reference = dataclasses.replace(THESIS_SCENARIO.reference, reference_end_s=end_s)
    return dataclasses.replace(THESIS_SCENARIO, reference=reference)


def _draw_reference(heading: str) -> Drawing:
    figure, (axes,) = new_chart(heading)
    time, values = reference_rpm(THESIS_SCENARIO, 'feedforward')
    axes.plot(time, values, label='reference', **REFERENCE_LINE)
    start_s = THESIS_SCENARIO.control_start_s
    axes.axvline(start_s, color=GREY, linewidth=1.0, label='control starts')
    label_time_axis(axes, 'Slip speed reference, rpm', (0.0, _LAST_S))
    return Drawing(
        figure,
        'The shape is that of the thesis: w_d under C_fOL alone until '
        f'{start_s:g} s, then a slope to zero. It prints no values: the '
        f'peak of {np.max(values):.0f} rpm and the slope come from our calibration on Table 5.1.',
    )


def _draw_engine_torque(heading: str) -> Drawing:
    figure, (axes,) = new_chart(heading)
    engine = Engine(THESIS_SCENARIO.engine)
    steps = np.arange(round(_LAST_S / PERIOD_S) + 1)
    torque = np.array([engine.torque(int(step)) for step in steps])
    axes.plot(steps * PERIOD_S, torque, label='C_m', **next(line_styles()))
    label_time_axis(axes, 'Engine torque C_m, N m', (0.0, _LAST_S))
    return Drawing(
        figure,
        'The "sudden growth" in "the first 0.5 seconds" (Chapter 6) is here. The thesis prints no '
        f'values: the rise to {np.max(torque):.0f} N m is calibrated on Table 5.1.',
    )


def _draw_plants(heading: str) -> Drawing:
    figure, (axes,) = new_chart(heading)
    run = thesis_run('pi', 'detailed', 1.0)
    detailed = rpm_from_rad_s(run.slip_speed)
    axes.plot(run.time_s, detailed, color='#c4c4c4', linewidth=6, label='detailed model')
    printed = {_PRINTED_PLANT: printed_lti_plant(THESIS_SCENARIO.driveline)}
    for (name, slip), style in zip(
        _plant_slips({**_simplified_plants(), **printed}).items(), line_styles(), strict=False
    ):
        axes.plot(run.time_s, rpm_from_rad_s(slip), label=name, **style)
    label_time_axis(axes, 'w_d, rpm', (0.0, run.time_s[-1]))
    rounding = 100.0 * _deviations(printed)[_PRINTED_PLANT]
    return Drawing(
        figure,
        'The thesis finds all models equal. Here the three simplified ones are within '
        f'{deviation_bound_percent():g} % of the peak; the rounding of the printed coefficients '
        f'makes {rounding:.1f} %. The run is that of the PI.',
    )


def deviation_bound_percent() -> float:
    """Return the power of ten within which w_d of the simplified models is, of its peak."""
    return 10.0 ** math.ceil(math.log10(100.0 * max(_deviations(_simplified_plants()).values())))


def _simplified_plants() -> dict[str, SimplifiedPlant]:
    parameters = THESIS_SCENARIO.driveline
    return {
        'elementary blocks': ElementaryBlockPlant(parameters),
        'state space': StateSpacePlant(parameters),
        'LTI': lti_plant(parameters),
    }


def _plant_slips(plants: Mapping[str, SimplifiedPlant]) -> dict[str, np.ndarray]:
    """Return w_d in rad/s of each model under the torques of the PI's run, (N+1,)."""
    run = thesis_run('pi', 'detailed', 1.0)
    start = np.array([*run.joint_speed[0, :3], run.joint_position[0, 3]])
    torques = run.engine_torque[:-1], run.clutch_torque[:-1], run.load_torque[:-1]
    return {name: plant.simulate(*torques, start) for name, plant in plants.items()}


def _deviations(plants: Mapping[str, SimplifiedPlant]) -> dict[str, float]:
    detailed = thesis_run('pi', 'detailed', 1.0).slip_speed
    return {
        name: float(np.abs(slip - detailed).max() / np.abs(detailed).max())
        for name, slip in _plant_slips(plants).items()
    }


def _draw_tanh(heading: str) -> Drawing:
    figure, (axes,) = new_chart(heading)
    for end_s, style in zip(_END_TIMES_S, line_styles(), strict=False):
        time, values = reference_rpm(tanh_scenario(end_s), 'feedforward_tanh')
        axes.plot(time, values, label=f'tanh, zero at {end_s:.1f} s', **style)
    axes.plot(*reference_rpm(THESIS_SCENARIO, 'feedforward'), label="CRF's", **REFERENCE_LINE)
    label_time_axis(axes, 'Slip speed reference, rpm', (0.0, _LAST_S))
    return Drawing(
        figure,
        'Goes to zero more smoothly than that of CRF, at a time that can be chosen, as the thesis '
        'says. It prints no formula: steepness and end are ours.',
    )


SCENARIO_FIGURES = (
    ThesisFigure('1.12', 'Reference signal', _draw_reference),
    ThesisFigure('1.14', 'C_m torque signal', _draw_engine_torque),
    ThesisFigure('1.23', 'Slip speed w_d of the detailed and the simplified models', _draw_plants),
    ThesisFigure('1.27', 'tanh-shaped reference', _draw_tanh),
)
