"""A controller of clutch and engine that estimates the wear of the clutch on line."""

from dataclasses import replace

import numpy as np

from ddct_controllers.interface import ControllerContext, Measurement, Status
from ddct_controllers.mpc.observer import NoiseLevels
from ddct_controllers.mpc.settings import MpcSettings
from ddct_controllers.mpc.thesis_mpc4 import mpc4_options, mpc4_settings
from ddct_controllers.mpc.transmission_model import (
    LOAD_TORQUE,
    TransmissionModel,
    transmission_model,
    with_disturbances,
)
from ddct_controllers.mpc.two_input_mpc import TwoInputController
from ddct_controllers.mpc.wear_observer import WearNoise, WearObserver
from ddct_plant.engine import EngineAuthority
from ddct_plant.initial import initial_state

NAME = 'mpc4_wear'
SLIP_ACCELERATION_WEIGHT = 0.05
"""Per rad/s^2 of dw_d/dt: an error of the slip then decays with a time constant of 0.11 s."""
DEMAND_WEIGHT = 0.05
"""Per N m: C_m returns to the demand with a time constant of 0.8 s, far slower than the slip."""


class TwoInputWearMpc(TwoInputController):
    """
    Predicts with the clutch gain K_usura that is estimated.

    Slip is linear in K_usura times the request, so that with everything else divided by K_usura,
    C_m included, the program of a new clutch holds at every wear, as in `WearMpc`.
    """

    def __init__(
        self,
        model: TransmissionModel,
        observer: WearObserver,
        settings: MpcSettings,
        authority: EngineAuthority,
    ) -> None:
        """Take the model of a new clutch with the error of C_load as its disturbance."""
        self._wear_observer = observer
        super().__init__(model, observer, settings, authority)

    def _solve(
        self, state: np.ndarray, before: np.ndarray, jump: np.ndarray, measurement: Measurement
    ) -> tuple[np.ndarray, Status]:
        """Solve with everything but the request divided by K_usura; `state` already is."""
        gain = self._wear_observer.wear_gain
        divided = replace(
            measurement,
            load_torque=measurement.load_torque / gain,
            slip_reference=[speed / gain for speed in measurement.slip_reference],
            slip_reference_rate=[rate / gain for rate in measurement.slip_reference_rate],
        )
        moves, status = self._solve_divided(state, before, jump, divided, gain)
        return moves, (*status, ('wear_gain_estimate', repr(gain)))


def make_two_input_wear_mpc(context: ControllerContext) -> TwoInputWearMpc:
    """Build `mpc4_wear`; raise ParameterError for a key that it does not take."""
    scenario = context.settings.scenario
    settings = mpc4_settings(SLIP_ACCELERATION_WEIGHT, DEMAND_WEIGHT)
    model = transmission_model(scenario.driveline)
    observer = WearObserver(
        model,
        NoiseLevels(),
        WearNoise(),
        scenario.driveline.halfshaft_stiffness,
        initial_state(context.settings).torque_request,
    )
    augmented = with_disturbances(model, model.b[:, LOAD_TORQUE : LOAD_TORQUE + 1])
    return TwoInputWearMpc(
        augmented, observer, mpc4_options(NAME, settings, context.gains), scenario.engine_authority
    )
