"""Tables 2.1 and 3.1: rise time and overshoot of every printed controller."""

from collections.abc import Iterable

from ddct_controllers.design.analysis.loops import ContinuousLoop, continuous_loop
from ddct_controllers.design.analysis.step_response import overshoot, rise_time_s, step_response
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace

_DURATION_S = 8.0
_RISE_TOLERANCE = (0.08, 0.02)
_OVERSHOOT_TOLERANCE = 1.5
"""Those of Tables 2.1 and 3.1: a fraction or seconds, and points; what is read off a plot."""


def step_values(names: Iterable[str]) -> dict[str, float | None]:
    """Return `NAME.rise time` in s and `NAME.overshoot` in % of these controllers."""
    found: dict[str, float | None] = {}
    for name in names:
        rise_time, percent = step_figures(continuous_loop(PRINTED_CONTROLLERS[name]))
        found |= {f'{name}.rise time': rise_time, f'{name}.overshoot': percent}
    return found


def fulfilled(controller: FactoredTransferFunction, specifications: TimeSpecifications) -> str:
    """Return which specifications the step response meets, as far as a plot can tell."""
    rise_time, percent = step_figures(continuous_loop(controller))
    limit = specifications.rise_time_s
    quick = rise_time is not None and rise_time <= limit + max(
        _RISE_TOLERANCE[0] * limit, _RISE_TOLERANCE[1]
    )
    low = percent <= 100.0 * specifications.overshoot + _OVERSHOOT_TOLERANCE
    if quick and low:
        return 'both'
    return 'only the rise time' if quick else 'only the overshoot' if low else 'none'


def step_figures(loop: ContinuousLoop | StateSpace) -> tuple[float | None, float]:
    """Return the rise time in s, and the overshoot in %."""
    response = step_response(loop, _DURATION_S)
    return rise_time_s(*response), 100.0 * overshoot(*response)
