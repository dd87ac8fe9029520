"""MPC3 that estimates the wear of the clutch on line and predicts with it."""

from dataclasses import replace

import numpy as np

from ddct_controllers.interface import ControllerContext, Measurement
from ddct_controllers.mpc.observer import NoiseLevels
from ddct_controllers.mpc.offset_free_mpc import BASIS
from ddct_controllers.mpc.options import number_option, with_options
from ddct_controllers.mpc.predictive_controller import PredictiveController
from ddct_controllers.mpc.settings import MpcSettings
from ddct_controllers.mpc.thesis_mpc import thesis_settings
from ddct_controllers.mpc.transmission_model import (
    LOAD_TORQUE,
    TransmissionModel,
    transmission_model,
    with_disturbances,
)
from ddct_controllers.mpc.wear_observer import WearNoise, WearObserver
from ddct_plant.initial import initial_state

_NAME = 'mpc_wear'


class WearMpc(PredictiveController):
    """
    A predictive controller whose prediction has the clutch gain K_usura that is estimated.

    Slip is linear in K_usura times the request. With the driveline's states, C_m, C_load and the
    references divided by K_usura, the request therefore obeys the program of a new clutch, which
    is condensed once; limits and moves remain those of the request. The cost is that of the
    transmitted torque's moves, so that the closed loop is the same at every wear.
    """

    def __init__(
        self, model: TransmissionModel, observer: WearObserver, settings: MpcSettings
    ) -> None:
        """Take the model of a new clutch with the error of C_load as its disturbance."""
        self._wear_observer = observer
        super().__init__(model, observer, settings)

    @property
    def observer(self) -> WearObserver:
        """What estimates its state and K_usura."""
        return self._wear_observer

    def _solve(
        self, state: np.ndarray, before: np.ndarray, jump: np.ndarray, measurement: Measurement
    ) -> tuple[np.ndarray, tuple[tuple[str, str], ...]]:
        """Solve with everything that drives the slip divided by K_usura; `state` already is."""
        observer = self._wear_observer
        gain = observer.wear_gain
        scaled = replace(
            measurement,
            engine_torque=measurement.engine_torque / gain,
            load_torque=measurement.load_torque / gain,
            slip_reference=[speed / gain for speed in measurement.slip_reference],
            slip_reference_rate=[rate / gain for rate in measurement.slip_reference_rate],
        )
        moves, status = super()._solve(state, before, jump, scaled)
        return moves, (
            *status,
            ('wear_gain_estimate', repr(gain)),
            ('wear_gain_deviation', repr(observer.wear_gain_deviation)),
        )


def make_wear_mpc(context: ControllerContext) -> WearMpc:
    """Build `mpc_wear`; raise ParameterError for an option that it does not take."""
    options = context.gains
    defaults = {'gain_drift': WearNoise.gain_drift, 'load_drift_n_m': WearNoise.load_drift_n_m}
    settings = with_options(_NAME, thesis_settings(BASIS), options, tuple(defaults))
    wear = WearNoise(
        **{
            key: number_option(_NAME, options, key, default, at_least=0.0)
            for key, default in defaults.items()
        }
    )
    driveline = context.settings.scenario.driveline
    model = transmission_model(driveline)
    observer = WearObserver(
        model,
        NoiseLevels(),
        wear,
        driveline.halfshaft_stiffness,
        initial_state(context.settings).torque_request,
    )
    augmented = with_disturbances(model, model.b[:, LOAD_TORQUE : LOAD_TORQUE + 1])
    return WearMpc(augmented, observer, settings)
