"""G_c(z), what the control unit computes every 10 ms for a continuous G_c(s)."""

from ddct_controllers.design.factored_form import factored_form
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import FactoredTransferFunction, discretise_zoh


def pulse_transfer_function(controller: FactoredTransferFunction) -> FactoredTransferFunction:
    """
    Return the zero-order-hold equivalent at 10 ms, as the thesis's `c2d` gives it (Section 2.2.2).

    The variable of the result is z: a number a stands for (z + a), (b, c) for z^2 + b z + c.
    """
    return factored_form(discretise_zoh(controller.to_state_space(), PERIOD_S))
