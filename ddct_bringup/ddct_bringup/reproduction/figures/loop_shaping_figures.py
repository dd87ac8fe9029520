"""Figures 2.7 to 2.10: the loops of the loop-shaping design, and the step response of G_c2."""

from ddct_bringup.reproduction.figures.thesis_figure import Drawing, ThesisFigure
from ddct_controllers.design.analysis.loop_curve import LoopCurve
from ddct_controllers.design.analysis.loops import continuous_loop
from ddct_controllers.design.analysis.margins import loop_margins
from ddct_controllers.design.analysis.step_response import overshoot, rise_time_s, step_response
from ddct_controllers.design.drawing.chart_style import new_chart
from ddct_controllers.design.drawing.charts import draw_nichols, draw_step_response
from ddct_controllers.design.loop_shaping.design import (
    NETWORK_SPECIFICATIONS,
    PLACEMENT_SPECIFICATIONS,
)
from ddct_controllers.design.loop_shaping.networks import integrators
from ddct_controllers.design.loop_shaping.nichols import contours, nichols_curve
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_controllers.printed import LOOP_SHAPING_CONTROLLERS
from ddct_plant.linear.lti import FactoredTransferFunction

_G_C1 = LOOP_SHAPING_CONTROLLERS['ls2']
_G_C2 = LOOP_SHAPING_CONTROLLERS['ls7']
_STEP_DURATION_S = 4.0


def draw_loop_in_nichols(
    heading: str,
    name: str,
    controller: FactoredTransferFunction,
    specifications: TimeSpecifications,
    thesis_says: str,
) -> Drawing:
    """Draw L of one controller, without hold and delay, with the bounds that it was made for."""
    figure, (axes,) = new_chart(heading)
    loop = continuous_loop(controller)
    curve = LoopCurve(loop)
    draw_nichols(axes, {name: nichols_curve(curve.values)}, specifications)
    margins = loop_margins(loop)
    if not margins.stable:
        return Drawing(figure, f'The closed loop is unstable. Thesis: {thesis_says}.')
    crossed = [
        f'enters the {found.name} curve (peak {found.peak:.2f}, allowed {found.level:.2f})'
        for found in contours(curve, specifications)
        if not found.respected
    ]
    return Drawing(
        figure,
        f'Crossover {margins.crossover_rad_s:.2f} rad/s, phase margin '
        f'{margins.phase_margin_deg:.0f}°, gain margin {margins.gain_margin_db:.0f} dB; L '
        f'{" and ".join(crossed) or "stays out of both curves"}. Thesis: {thesis_says}.',
    )


def draw_step(
    heading: str, name: str, controller: FactoredTransferFunction, printed: tuple[float, float]
) -> Drawing:
    """Draw the step response of one loop; `printed` are the thesis's t_r in s and overshoot."""
    figure, (axes,) = new_chart(heading)
    time, output = step_response(continuous_loop(controller), _STEP_DURATION_S)
    draw_step_response(axes, {name: (time, output)})
    return Drawing(
        figure,
        f'Computed t_r = {rise_time_s(time, output):.2f} s and overshoot '
        f'{100.0 * overshoot(time, output):.0f} %; the thesis prints {printed[0]:.2f} s and '
        f'{100.0 * printed[1]:.0f} %.',
    )


LOOP_SHAPING_FIGURES = (
    ThesisFigure(
        '2.7',
        'Nichols chart with G_c(s) = K_c/s, K_c = -1',
        lambda title: draw_loop_in_nichols(
            title,
            'L with G_c = -1/s',
            integrators(-1.0, 1),
            NETWORK_SPECIFICATIONS,
            'very close to -1, and 70° of phase are missing',
        ),
    ),
    ThesisFigure(
        '2.8',
        'Nichols chart with G_c1(s)',
        lambda title: draw_loop_in_nichols(
            title,
            'L with G_c1',
            _G_C1,
            NETWORK_SPECIFICATIONS,
            'far from -1, but crosses the circle',
        ),
    ),
    ThesisFigure(
        '2.9',
        'Nichols chart with G_c2(s)',
        lambda title: draw_loop_in_nichols(
            title,
            'L with G_c2',
            _G_C2,
            PLACEMENT_SPECIFICATIONS,
            'the specifications are met; it does not mention the curve',
        ),
    ),
    ThesisFigure(
        '2.10',
        'Step response with G_c2(s)',
        lambda title: draw_step(title, 'G_c2', _G_C2, (0.52, 0.13)),
    ),
)
"""Those of Section 2.2.2."""
