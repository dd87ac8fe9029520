"""`mpc_preview` that estimates the wear of the clutch on line and predicts with it."""

import numpy as np

from ddct_controllers.interface import ControllerContext, Measurement, Status
from ddct_controllers.mpc.build import make_wear_observer
from ddct_controllers.mpc.estimate.disturbances import offset_free_model
from ddct_controllers.mpc.estimate.wear_noise import WearNoise
from ddct_controllers.mpc.estimate.wear_observer import WearObserver
from ddct_controllers.mpc.options import with_options
from ddct_controllers.mpc.predictive_controller import PredictiveController
from ddct_controllers.mpc.thesis_mpc import BASIS, thesis_settings
from ddct_controllers.mpc.wear_prediction import WEAR_OPTIONS, divided, wear_noise, wear_status

_NAME = 'mpc_wear'


class WearMpc(PredictiveController[WearObserver]):
    """
    A predictive controller whose prediction has the clutch gain K_usura that is estimated.

    Its program is that of a new clutch, condensed once, for everything `divided` by the estimate;
    limits and moves remain those of the request. The model is the `offset_free_model` of a new
    clutch. The cost is that of the transmitted torque's
    moves, so that the closed loop is the same at every wear.
    """

    def _output_divisor(self) -> float:
        return self.observer.wear_gain

    def _solve(
        self, state: np.ndarray, before: np.ndarray, jump: np.ndarray, measurement: Measurement
    ) -> tuple[np.ndarray, Status]:
        """Solve with everything that drives the slip divided by K_usura; `state` already is."""
        scaled = divided(measurement, self.observer.wear_gain)
        moves, status = super()._solve(state, before, jump, scaled)
        return moves, (*status, *wear_status(self.observer))


def make_wear_mpc(context: ControllerContext) -> WearMpc:
    """Build `mpc_wear`; raise ParameterError for an option that it does not take."""
    settings = thesis_settings(BASIS, preview=True)
    settings = with_options(_NAME, settings, context.gains, WEAR_OPTIONS)
    wear = wear_noise(_NAME, context.gains, WearNoise())
    model = offset_free_model(context.settings.scenario.driveline)
    return WearMpc(model, make_wear_observer(context.settings, model, wear), settings)
