"""Parts of predictive controllers that depend on the run."""

from ddct_controllers.mpc.observer import NoiseLevels, Observer
from ddct_controllers.mpc.transmission_model import TransmissionModel
from ddct_controllers.mpc.wear_noise import WearNoise
from ddct_controllers.mpc.wear_observer import WearObserver
from ddct_plant.initial import initial_state
from ddct_plant.run_settings import RunSettings


def make_observer(
    settings: RunSettings, model: TransmissionModel, noise: NoiseLevels | None = None
) -> Observer:
    """Return an observer that starts as the run does: actuator at rest, load balanced."""
    return Observer(
        model,
        noise or NoiseLevels(),
        settings.scenario.driveline.halfshaft_stiffness,
        initial_state(settings).torque_request,
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
