"""Models with their observers, of which the predictive controllers are composed."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

from ddct_controllers.mpc.estimate.gains import (
    CLUTCH_DRIFT_N_M,
    LOAD_DRIFT_N_M,
    NoiseLevels,
    kalman_gain,
    offset_free_noise,
    unit_noise_gain,
)
from ddct_controllers.mpc.estimate.observer import AtRest, Observer
from ddct_controllers.mpc.estimate.wear_model import WearNoise
from ddct_controllers.mpc.estimate.wear_observer import WearObserver
from ddct_controllers.mpc.knowledge import Knowledge
from ddct_controllers.mpc.model.augmented import offset_free_model
from ddct_controllers.mpc.model.transmission_model import TransmissionModel, transmission_model
from ddct_controllers.mpc.options import MOST
from ddct_plant.base.options import OptionGroup, Options, option, with_values
from ddct_plant.scenario.initial import initial_state
from ddct_plant.scenario.settings import RunSettings


def run_start(settings: RunSettings) -> AtRest:
    """Return how a run starts: actuator at rest, load balanced."""
    return AtRest(
        settings.scenario.driveline.halfshaft_stiffness, initial_state(settings).torque_request
    )


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


def stationary_filter(
    run: RunSettings,
    knowledge: Knowledge,
    model: TransmissionModel | None = None,
    *,
    noise_rpm: float = 1.0,
) -> tuple[TransmissionModel, Observer]:
    """
    Return the model that is known of, and its filter.

    `model` takes the place of the one that is known of; `noise_rpm` is that of w_d where it is
    measured alone.
    """
    if model is None:
        model = transmission_model(run.scenario.driveline, delay=knowledge.delay_in_model)
    known = model if knowledge.load_known else model.without_load()
    if knowledge.measured == 'slip':
        return known, Observer(known, unit_noise_gain(known, noise_rpm), start=None)
    return known, make_observer(run, model, load_known=knowledge.load_known)


@dataclass(frozen=True)
class Filter:
    """`stationary_filter`, whose knowledge a scenario may change if it is `changeable`."""

    knowledge: Knowledge
    changeable: bool = False

    @property
    def options(self) -> Options:
        """What a scenario may change."""
        return self.knowledge.options if self.changeable else {}

    def parts(
        self, values: Mapping[str, Any], run: RunSettings
    ) -> tuple[TransmissionModel, Observer]:
        """Return model and observer for the values of its options."""
        return stationary_filter(run, with_values(self.knowledge, values))


@dataclass(frozen=True)
class DisturbanceObserver(OptionGroup):
    """The filter that estimates constant errors of C_f and C_load too."""

    clutch_drift_n_m: float = option(
        CLUTCH_DRIFT_N_M, 'drift of the error of C_f, per period', 'N m', above=0.0, at_most=MOST
    )
    load_drift_n_m: float = option(
        LOAD_DRIFT_N_M, 'drift of the error of C_load, per period', 'N m', above=0.0, at_most=MOST
    )

    def parts(
        self, values: Mapping[str, Any], run: RunSettings
    ) -> tuple[TransmissionModel, Observer]:
        """Return model and observer for the values of its options."""
        chosen = with_values(self, values)
        noise = offset_free_noise(chosen.clutch_drift_n_m, chosen.load_drift_n_m)
        model = offset_free_model(run.scenario.driveline)
        return model, make_observer(run, model, noise)


@dataclass(frozen=True)
class WearEstimate(OptionGroup):
    """The filter that estimates the wear of the clutch, with the model of a new one."""

    gain_drift: float = option(
        WearNoise.gain_drift,
        'drift of K_usura per period; the bounds of its estimate are 0.5 and 1.5',
        at_least=0.0,
        at_most=1.0,
    )
    clutch_drift_n_m: float = option(
        WearNoise.clutch_drift_n_m,
        'drift of the error of C_f per period while a bound holds K_usura; 0 leaves a slip '
        'error there',
        'N m',
        at_least=0.0,
        at_most=MOST,
    )
    load_drift_n_m: float = option(
        WearNoise.load_drift_n_m,
        'drift of the error of C_load per period',
        'N m',
        at_least=0.0,
        at_most=MOST,
    )

    def parts(
        self, values: Mapping[str, Any], run: RunSettings
    ) -> tuple[TransmissionModel, WearObserver]:
        """Return model and observer for the values of its options."""
        noise = WearNoise(**asdict(with_values(self, values)))
        model = offset_free_model(run.scenario.driveline)
        return model, WearObserver(model, NoiseLevels(), noise, run_start(run))
