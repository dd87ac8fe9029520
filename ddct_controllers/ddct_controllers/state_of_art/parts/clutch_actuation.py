"""The clutch torque that follows from requests, by the actuator's model."""

from ddct_controllers.interface import ControllerContext
from ddct_plant.base.timebase import SUBSTEPS
from ddct_plant.models.actuator import Actuator
from ddct_plant.scenario.initial import initial_state


class ClutchActuation:
    """Saturation, delay and G_a(s) in front of a clutch without wear."""

    def __init__(self, context: ControllerContext) -> None:
        """Start as the run does."""
        self._initial_request = initial_state(context.settings).torque_request
        self.reset()

    def reset(self) -> None:
        """Return to rest on the initial request."""
        self._actuator = Actuator(self._initial_request)

    def update(self, request: float) -> float:
        """
        Return the mean torque in N m over the coming period and take the request in N m in.

        The mean is what moves the engine; the request acts one period later.
        """
        nodes = self._actuator.update(request)
        return (sum(nodes) - 0.5 * (nodes[0] + nodes[-1])) / SUBSTEPS
