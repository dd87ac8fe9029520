"""Linear feedback on the slip error: a discrete transfer function G_c(z) in state-space form."""

import numpy as np

from ddct_controllers.interface import Command, Controller, Measurement
from ddct_plant.lti import FactoredTransferFunction, discretise_zoh
from ddct_plant.timebase import PERIOD_S


class LinearController(Controller):
    """
    u = G_c e with e in rpm and u in N m, discretised by zero-order hold at 10 ms.

    The hold is what the thesis's `c2d` uses: it gives the printed G_c(z) (Sections 2.2, 3.2).
    """

    def __init__(self, transfer_function: FactoredTransferFunction) -> None:
        """Discretise the continuous G_c(s)."""
        model = discretise_zoh(transfer_function.to_state_space(), PERIOD_S)
        self._state_update = np.hstack([model.a, model.b])
        self._output = np.hstack([model.c, model.d])[0]
        self._state_and_input = np.zeros(model.a.shape[0] + 1)

    def reset(self) -> None:
        """Set the state to zero."""
        self._state_and_input[:] = 0.0

    def update(self, measurement: Measurement) -> Command:
        """Return C_f = C x + D e and advance x by A x + B e."""
        values = self._state_and_input
        values[-1] = measurement.slip_error_rpm
        torque = float(self._output @ values)
        values[:-1] = self._state_update @ values
        return Command(torque)
