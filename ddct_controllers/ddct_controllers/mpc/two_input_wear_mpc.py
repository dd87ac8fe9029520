"""A controller of clutch and engine that estimates the wear of the clutch on line."""

from dataclasses import replace

import numpy as np

from ddct_controllers.interface import ControllerContext, Measurement, Status
from ddct_controllers.mpc.build import make_wear_observer
from ddct_controllers.mpc.estimate.disturbances import offset_free_model
from ddct_controllers.mpc.estimate.wear_noise import WearNoise
from ddct_controllers.mpc.estimate.wear_observer import WearObserver
from ddct_controllers.mpc.thesis_mpc4 import mpc4_options, mpc4_settings
from ddct_controllers.mpc.two_input_mpc import TwoInputController
from ddct_controllers.mpc.wear_prediction import WEAR_OPTIONS, divided, wear_noise, wear_status

NAME = 'mpc4_wear'
SLIP_ACCELERATION_WEIGHT = 0.05
"""Per rad/s^2 of dw_d/dt: an error of the slip then decays with a time constant of 0.11 s."""
DEMAND_WEIGHT = 0.05
"""Per N m: C_m returns to the demand with a time constant of 0.8 s, far slower than the slip."""
WEAR_NOISE = WearNoise(clutch_drift_n_m=0.0)
"""With a gain beyond its bounds an estimated error of C_f would make this loop oscillate."""


class TwoInputWearMpc(TwoInputController[WearObserver]):
    """
    Predicts with the clutch gain K_usura that is estimated, as `WearMpc` does.

    The model is the `offset_free_model` of a new clutch.
    """

    def _output_divisor(self) -> float:
        return self.observer.wear_gain

    def _solve(
        self, state: np.ndarray, before: np.ndarray, jump: np.ndarray, measurement: Measurement
    ) -> tuple[np.ndarray, Status]:
        """Solve with everything but the request divided by K_usura; `state` already is."""
        gain = self.observer.wear_gain
        # What the engine can reach follows from the demand itself.
        scaled = replace(divided(measurement, gain), engine_torque=measurement.engine_torque)
        moves, status = self._solve_divided(state, before, jump, scaled, gain)
        return moves, (*status, *wear_status(self.observer))


def make_two_input_wear_mpc(context: ControllerContext) -> TwoInputWearMpc:
    """Build `mpc4_wear`; raise ParameterError for a key that it does not take."""
    scenario = context.settings.scenario
    settings = mpc4_settings(SLIP_ACCELERATION_WEIGHT, DEMAND_WEIGHT)
    settings = mpc4_options(NAME, settings, context.gains, WEAR_OPTIONS)
    wear = wear_noise(NAME, context.gains, WEAR_NOISE)
    model = offset_free_model(scenario.driveline)
    observer = make_wear_observer(context.settings, model, wear)
    return TwoInputWearMpc(model, observer, settings, scenario.engine_authority)
