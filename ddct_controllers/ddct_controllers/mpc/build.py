"""Parts of predictive controllers that depend on the run."""

from ddct_controllers.mpc.observer import NoiseLevels, Observer
from ddct_controllers.mpc.transmission_model import TransmissionModel
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
