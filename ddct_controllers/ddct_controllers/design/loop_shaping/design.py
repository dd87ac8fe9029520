"""The thesis's loop shaping (Section 2.2): G_c1 from networks, G_c2 by placing poles and zeros."""

from dataclasses import dataclass

import scipy

from ddct_controllers.design.analysis.loops import continuous_loop, plant_in_rpm
from ddct_controllers.design.analysis.step_response import overshoot, step_response
from ddct_controllers.design.loop_shaping.networks import (
    integrators,
    lag_network,
    lead_network,
    with_crossover,
)
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_plant.linear.lti import FactoredTransferFunction
from ddct_plant.models.driveline_model import clutch_to_slip
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.printed import ACTUATOR

NETWORK_SPECIFICATIONS = TimeSpecifications(rise_time_s=0.25, overshoot=0.14)
"""What G_c1 is designed for."""
PLACEMENT_SPECIFICATIONS = TimeSpecifications(rise_time_s=0.6, overshoot=0.14)
"""What G_c2 is designed for."""
PLACEMENT_CROSSOVER_RAD_S = 3.5
"""w_c that the thesis takes for t_r = 0.6 s."""
_LEAD = lead_network(zero_rad_s=1.0, ratio=16.0)
"""As G_c1 has it: the text says z_d = w_c = 8 rad/s, the printed zeros and poles are 1 and 16."""
_LAG = lag_network(pole_rad_s=0.6, ratio=16.0)
_GAIN = 0.3
"""|K_c| of G_c1."""


@dataclass(frozen=True)
class DesignStep:
    """One stage of a design by hand."""

    name: str
    controller: FactoredTransferFunction


def network_steps() -> tuple[DesignStep, ...]:
    """Return the stages from K_c/s to G_c1, equation (2.1), which is the last one."""
    networks = integrators(1.0, 1) * _LEAD * _LEAD * _LAG
    return (
        DesignStep('-1/s', integrators(-1.0, 1)),
        DesignStep('and one lead', integrators(-1.0, 1) * _LEAD),
        DesignStep('and two leads', integrators(-1.0, 1) * _LEAD * _LEAD),
        DesignStep('and the lag', integrators(-1.0, 1) * _LEAD * _LEAD * _LAG),
        DesignStep('|K_c| = 0.3: G_c1', integrators(-_GAIN, 0) * networks),
    )


def placement(
    crossover_rad_s: float,
    zero_rad_s: float,
    parameters: DrivelineParameters,
    integrator_count: int = 1,
) -> FactoredTransferFunction:
    """
    Return a controller of G_c2's structure, equation (2.2), with the gain for the crossover.

    G_c = -k (s + z)^mu (slow poles of G_a) / (s^mu (locked-driveline zeros of P_2)): what it
    cancels leaves a loop that falls evenly around w_c. The thesis prints s^2 + 74.29 s + 2393 for
    the pair that is s^2 + 82.23 s + 2563 in G_a, as drawn by hand in Control System Designer.
    """
    driveline_zeros = next(f for f in clutch_to_slip(parameters).numerator if isinstance(f, tuple))
    actuator_poles = min(
        (f for f in ACTUATOR.denominator if isinstance(f, tuple)), key=lambda pair: pair[1]
    )
    shape = FactoredTransferFunction(
        -1.0,
        (zero_rad_s,) * integrator_count + (actuator_poles,),
        (0.0,) * integrator_count + (driveline_zeros,),
    )
    return with_crossover(shape, plant_in_rpm(parameters), crossover_rad_s)


def largest_zero_rad_s(
    crossover_rad_s: float, largest_overshoot: float, parameters: DrivelineParameters
) -> float:
    """
    Return the largest z of `placement` that keeps the overshoot, as the thesis's loop has it.

    A loop with two integrators overshoots, the more the larger z is; but the integrators work up
    to z only, so that a disturbance dies out the sooner the larger it is. Without delay and hold.
    """
    duration_s = 30.0 / crossover_rad_s

    def excess(zero_rad_s: float) -> float:
        controller = placement(crossover_rad_s, zero_rad_s, parameters)
        loop = continuous_loop(controller, parameters)
        return overshoot(*step_response(loop, duration_s)) - largest_overshoot

    return float(scipy.optimize.brentq(excess, 0.01 * crossover_rad_s, crossover_rad_s, rtol=1e-6))
