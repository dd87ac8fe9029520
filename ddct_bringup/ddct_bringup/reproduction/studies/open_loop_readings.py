"""Two readings of what becomes of the static controller beside an MPC."""

from dataclasses import replace

from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.mpc.controller import MpcController


class OpenLoopUnknown(Controller):
    """The MPC takes its own torque for all there is, while C_fOL acts beside it."""

    def __init__(self, controller: MpcController) -> None:
        self._controller = controller
        self.preview_steps = controller.preview_steps

    def reset(self) -> None:
        """Reset the MPC."""
        self._controller.reset()

    def hold(self, measurement: Measurement) -> None:
        """Hold the MPC, which believes that the clutch is open."""
        self._controller.hold(replace(measurement, open_loop_torque=0.0))

    def update(self, measurement: Measurement) -> Command:
        """Return the MPC's answer, to which the architecture adds C_fOL."""
        return self._controller.update(replace(measurement, open_loop_torque=0.0))


class OpenLoopOff(Controller):
    """
    C_fOL is taken off at control start, and the MPC gives the whole torque.

    With `from_zero` its moves are counted from no torque at all, so the first has to bring it all;
    otherwise from the torque that there was.
    """

    def __init__(self, controller: MpcController, *, from_zero: bool = False) -> None:
        self._controller = controller
        self._from_zero = from_zero
        self.preview_steps = controller.preview_steps
        self._taken_over = 0.0

    def reset(self) -> None:
        """Reset the MPC and forget the torque."""
        self._controller.reset()
        self._taken_over = 0.0

    def hold(self, measurement: Measurement) -> None:
        """Note the torque to go on from."""
        self._controller.hold(measurement)
        self._taken_over = 0.0 if self._from_zero else measurement.open_loop_torque

    def update(self, measurement: Measurement) -> Command:
        """Return the MPC's whole request less the C_fOL that the architecture adds."""
        command = self._controller.update(replace(measurement, open_loop_torque=self._taken_over))
        whole = command.clutch_torque + self._taken_over
        return replace(command, clutch_torque=whole - measurement.open_loop_torque)
