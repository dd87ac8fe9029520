"""Linear feedback on the slip error: a discrete transfer function G_c(z) in state-space form."""

from ddct_controllers.discrete_filter import DiscreteFilter
from ddct_controllers.interface import (
    UNSTATED,
    Command,
    Controller,
    ControllerSpec,
    Measurement,
)
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace, discretise_zoh


class LinearController(Controller):
    """
    u = G_c e with e in rpm and u in N m, sampled at 10 ms.

    A continuous G_c(s) is discretised by zero-order hold, which is what the thesis's `c2d` uses:
    it gives the printed G_c(z) (Sections 2.2, 3.2).
    """

    def __init__(self, controller: FactoredTransferFunction | StateSpace) -> None:
        """Discretise G_c(s), or take G_c(z); raise ParameterError when it is neither."""
        if isinstance(controller, FactoredTransferFunction):
            controller = discretise_zoh(controller.to_state_space(), PERIOD_S)
        elif controller.period_s != PERIOD_S or controller.d.shape != (1, 1):
            raise ParameterError(
                f'linear controller: a state space must have one input, one output and a period '
                f'of {PERIOD_S} s'
            )
        self._model = controller
        self._filter = DiscreteFilter(self._model)

    def reset(self) -> None:
        """Set the state to zero."""
        self._filter.reset()

    def update(self, measurement: Measurement) -> Command:
        """Return C_f = C x + D e and advance x by A x + B e."""
        return Command(self._filter.update(measurement.slip_error_rpm))

    def linear_model(self) -> StateSpace:
        """Return G_c(z)."""
        return self._model


def linear_spec(
    name: str,
    controller: FactoredTransferFunction | StateSpace,
    computed_from: str = UNSTATED,
) -> ControllerSpec[Controller]:
    """Return how the linear controller called `name`, which takes no options, is made."""
    return ControllerSpec(name, lambda context: LinearController(controller), {}, computed_from)
