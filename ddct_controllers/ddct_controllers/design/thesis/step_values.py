"""Tables 2.1 and 3.1: rise time and overshoot of every printed controller."""

from collections.abc import Iterable

from ddct_controllers.design.analysis.loops import ContinuousLoop, continuous_loop
from ddct_controllers.design.analysis.step_response import overshoot, rise_time_s, step_response
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.lti import FactoredTransferFunction, StateSpace
from ddct_plant.units import RAD_S_PER_RPM

_DURATION_S = 8.0


def step_values(names: Iterable[str]) -> dict[str, float | None]:
    """Return `NAME.rise time` in s and `NAME.overshoot` in % of these controllers."""
    found: dict[str, float | None] = {}
    for name in names:
        rise_time, percent = step_figures(continuous_loop(PRINTED_CONTROLLERS[name]))
        found |= {f'{name}.rise time': rise_time, f'{name}.overshoot': percent}
    return found


def rise_time_without_rpm() -> float | None:
    """Return LS8's rise time in s when it acts on the error in rad/s."""
    controller = PRINTED_CONTROLLERS['ls8'] * FactoredTransferFunction(RAD_S_PER_RPM)
    return step_figures(continuous_loop(controller))[0]


def fulfilled(name: str, specifications: TimeSpecifications) -> str:
    """Return whether a printed controller's step response meets the specifications."""
    rise_time, percent = step_figures(continuous_loop(PRINTED_CONTROLLERS[name]))
    quick = rise_time is not None and rise_time < specifications.rise_time_s
    return 'fulfilled' if quick and percent < 100.0 * specifications.overshoot else 'missed'


def step_figures(loop: ContinuousLoop | StateSpace) -> tuple[float | None, float]:
    """Return the rise time in s, and the overshoot in %."""
    response = step_response(loop, _DURATION_S)
    return rise_time_s(*response), 100.0 * overshoot(*response)
