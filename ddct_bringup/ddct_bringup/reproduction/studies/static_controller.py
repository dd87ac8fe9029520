"""The thesis's static controller (Figure 1.17) without a closed loop beside it."""

from ddct_controllers.interface import Command, Controller, Measurement


class StaticControllerAlone(Controller):
    """Leaves the clutch to C_fOL and the engine to the driver."""

    def reset(self) -> None:
        """There is nothing to forget."""

    def update(self, measurement: Measurement) -> Command:
        """Return no torque."""
        return Command(0.0)
