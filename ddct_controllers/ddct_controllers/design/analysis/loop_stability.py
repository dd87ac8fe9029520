"""Is a closed loop stable? By its poles; with a dead time, by counting those that it moves."""

import math

import numpy as np

from ddct_controllers.design.analysis.loop_curve import LoopCurve
from ddct_controllers.design.analysis.loops import ContinuousLoop
from ddct_controllers.design.state_space import close_loop
from ddct_plant.linear.lti import StateSpace


def closed_loop_stable(loop: ContinuousLoop | StateSpace) -> bool:
    """Return whether L closed by unit negative feedback has no pole on or beyond the boundary."""
    return unstable_poles(loop) == 0


def unstable_poles(loop: ContinuousLoop | StateSpace) -> int:
    """
    Return how many poles the closed loop has on or beyond the stability boundary.

    With a dead time tau there are infinitely many poles, and all but a few are stable. Growing
    from 0, tau takes two across at w when L(jw) exp(-jw tau) = -1: outwards where |L| falls with
    frequency, inwards where it rises (Walton and Marshall's direct method). L is strictly proper.
    """
    if not isinstance(loop, ContinuousLoop):
        return _unstable(loop)
    without_delay = ContinuousLoop(loop.transfer_function)
    count = _unstable(without_delay.to_state_space())
    if not loop.delay_s:
        return count
    curve = LoopCurve(without_delay)
    for omega in curve.crossings(lambda values: np.log(np.abs(values))):
        first_s = np.angle(-curve.at(omega)) % math.tau / omega
        times = math.floor((loop.delay_s - first_s) * omega / math.tau) + 1
        falling = abs(curve.at(omega * (1.0 - 1e-6))) > 1.0
        count += 2 * max(times, 0) * (1 if falling else -1)
    return count


def _unstable(loop: StateSpace) -> int:
    poles = np.linalg.eigvals(close_loop(loop).a)
    beyond = poles.real >= 0.0 if loop.period_s is None else np.abs(poles) >= 1.0
    return int(np.count_nonzero(beyond))
