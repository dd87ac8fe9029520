"""Readings in which the driveline's whole state is measured, which no car does."""

from collections.abc import Callable

import numpy as np

from ddct_bringup.run.headless import ClosedLoop
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.estimate.observer import Observer
from ddct_controllers.mpc.estimators import run_start
from ddct_controllers.mpc.model.transmission_model import MEASURED, TransmissionModel
from ddct_plant.scenario.settings import RunSettings

TWIST = MEASURED
"""Place of theta_sr in the state, after the speeds."""


class MeasuredState(Observer):
    """Takes w_m, w_p, w_r and theta_sr as measured; the actuator's states follow by the model."""

    def __init__(self, settings: RunSettings, model: TransmissionModel) -> None:
        super().__init__(model, np.eye(len(model.a), MEASURED + 1), run_start(settings))
        self.twist: Callable[[], float] | None = None
        """Measures theta_sr in rad; without it there is no estimate."""

    def correct(self, speeds: tuple[float, float, float], load_torque: float) -> np.ndarray:
        """Return x_k, (n,), for w_m, w_p, w_r in rad/s and C_load in N m."""
        assert self.twist is not None
        if not self._started:
            super().correct(speeds, load_torque)
        self._state[:MEASURED], self._state[TWIST] = speeds, self.twist()
        return self._state


class LoopWithMeasuredState(ClosedLoop):
    """The closed loop, which lets its controller's `MeasuredState` measure the twist."""

    def __init__(self, settings: RunSettings, controller: MpcController[MeasuredState]) -> None:
        """Start in the run's initial state."""
        super().__init__(settings, controller)
        controller.observer.twist = lambda: float(self._driveline.outputs().joint_position[TWIST])
