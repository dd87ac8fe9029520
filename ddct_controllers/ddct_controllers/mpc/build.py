"""Parts of predictive controllers that depend on the run."""

import math
from dataclasses import replace

from ddct_controllers.mpc.estimate.observer import AtRest, NoiseLevels, Observer, kalman_gain
from ddct_controllers.mpc.estimate.wear_noise import WearNoise
from ddct_controllers.mpc.estimate.wear_observer import WearObserver
from ddct_controllers.mpc.model.transmission_model import TransmissionModel
from ddct_plant.scenario.initial import initial_state
from ddct_plant.scenario.settings import RunSettings


def make_observer(
    settings: RunSettings,
    model: TransmissionModel,
    noise: NoiseLevels | None = None,
    *,
    load_known: bool = True,
) -> Observer:
    """
    Return the Kalman filter of the measured w_m, w_p and w_r that starts as the run does.

    The actuator is at rest and the load, if it is known, balanced.
    """
    gain = kalman_gain(model, noise or NoiseLevels())
    start = run_start(settings)
    if load_known:
        return Observer(model, gain, start)
    return Observer(model.without_load(), gain, replace(start, halfshaft_stiffness=math.inf))


def run_start(settings: RunSettings) -> AtRest:
    """Return how a run starts: actuator at rest, load balanced."""
    return AtRest(
        settings.scenario.driveline.halfshaft_stiffness, initial_state(settings).torque_request
    )


def make_wear_observer(
    settings: RunSettings, model: TransmissionModel, wear: WearNoise
) -> WearObserver:
    """Return the same for `WearObserver`, which takes the `offset_free_model`."""
    return WearObserver(
        model,
        NoiseLevels(),
        wear,
        settings.scenario.driveline.halfshaft_stiffness,
        initial_state(settings).torque_request,
    )
