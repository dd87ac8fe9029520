"""Models with their observers, of which the predictive controllers are composed."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar

from ddct_controllers.interface import ControllerContext
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
from ddct_controllers.mpc.knowledge import Knowledge, with_knowledge
from ddct_controllers.mpc.model.augmented import offset_free_model
from ddct_controllers.mpc.model.transmission_model import TransmissionModel, transmission_model
from ddct_controllers.mpc.options import MOST, number_option
from ddct_plant.scenario.initial import initial_state
from ddct_plant.scenario.settings import RunSettings

WEAR_OPTIONS = ('gain_drift', 'clutch_drift_n_m', 'load_drift_n_m')
"""Fields of `WearNoise` that `controllers.<name>` may give."""
MOST_GAIN_DRIFT = 1.0
"""Per period, as much as the bounds of the estimate are apart."""
_DRIFTS = {'clutch_drift_n_m': CLUTCH_DRIFT_N_M, 'load_drift_n_m': LOAD_DRIFT_N_M}


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
    """`stationary_filter`, with what of its knowledge a scenario may change."""

    knowledge: Knowledge
    keys: tuple[str, ...] = ()

    def parts(self, name: str, context: ControllerContext) -> tuple[TransmissionModel, Observer]:
        """Return model and observer; raise ParameterError for a bad option."""
        knowledge = with_knowledge(name, self.knowledge, context.gains)
        return stationary_filter(context.settings, knowledge)


@dataclass(frozen=True)
class DisturbanceObserver:
    """The filter that estimates constant errors of C_f and C_load too."""

    keys: ClassVar = tuple(_DRIFTS)

    def parts(self, name: str, context: ControllerContext) -> tuple[TransmissionModel, Observer]:
        """Return model and observer; raise ParameterError for a bad option."""
        drifts = {
            key: number_option(name, context.gains, key, default, above=0.0)
            for key, default in _DRIFTS.items()
        }
        model = offset_free_model(context.settings.scenario.driveline)
        return model, make_observer(context.settings, model, offset_free_noise(**drifts))


@dataclass(frozen=True)
class WearEstimate:
    """The filter that estimates the wear of the clutch, with the model of a new one."""

    noise: WearNoise
    keys: ClassVar = WEAR_OPTIONS

    def parts(
        self, name: str, context: ControllerContext
    ) -> tuple[TransmissionModel, WearObserver]:
        """Return model and observer; raise ParameterError for a bad option."""
        noise = wear_noise(name, context.gains, self.noise)
        model = offset_free_model(context.settings.scenario.driveline)
        return model, WearObserver(model, NoiseLevels(), noise, run_start(context.settings))


def wear_noise(name: str, options: Mapping[str, Any], default: WearNoise) -> WearNoise:
    """Return `default` changed by `controllers.<name>`; raise ParameterError for a bad level."""
    most = {'gain_drift': MOST_GAIN_DRIFT}
    given = {
        key: number_option(
            name, options, key, getattr(default, key), at_least=0.0, at_most=most.get(key, MOST)
        )
        for key in WEAR_OPTIONS
    }
    return replace(default, **given)
