# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Models with their observers, of which the predictive controllers are composed."""

import math
from dataclasses import dataclass, replace

from ddct_controllers.mpc.estimate.observer import (
    OF_CLUTCH,
    OF_LOAD,
    AtRest,
    Drifts,
    NoiseLevels,
    Observer,
    kalman_gain,
    unit_noise_gain,
)
from ddct_controllers.mpc.estimate.wear_observer import WearNoise, WearObserver
from ddct_controllers.mpc.model.disturbances import offset_free_model
from ddct_controllers.mpc.model.transmission_model import TransmissionModel, transmission_model
from ddct_controllers.mpc.program.settings import MOST
from ddct_plant.base.options import REQUIRED, OptionGroup, option
from ddct_plant.models.actuator import PRINTED_ACTUATOR
from ddct_plant.scenario.initial_state import initial_request
from ddct_plant.scenario.settings import KnownSettings

PRINTED, KNOWN = 'printed', 'known'
"""Actuators that a model may have: that of the thesis, and that of the known settings."""


def run_start(settings: KnownSettings) -> AtRest:
    """Return the start of a run for an observer: actuator at rest, load balanced."""
    stiffness = settings.scenario.driveline.halfshaft_stiffness
    return AtRest(stiffness, initial_request(settings))


def make_observer(
    settings: KnownSettings,
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
    return Observer(model.without_load, gain, replace(start, halfshaft_stiffness=math.inf))


@dataclass(frozen=True)
class ObserverInputs(OptionGroup):
    """
    Signals that a stationary filter receives, and the model that it uses.

    Each choice of signals comes with the filter designed for it. C_m and C_fOL are always inputs.
    """

    measured: str = option(
        REQUIRED,
        '`slip` is w_d alone, `speeds` are w_m, w_p and w_r',
        kind=str,
        choices=('slip', 'speeds'),
    )
    load_known: bool = option(
        REQUIRED,
        'whether C_load, computed from V_x and the slope, is an input of the model',
        kind=bool,
    )
    delay_in_model: bool = option(
        REQUIRED, 'whether the model has the delay of the actuator, beside G_a(s)', kind=bool
    )
    actuator_in_model: str = option(
        REQUIRED,
        "`printed` is the thesis's actuator, `known` that of the scenario",
        kind=str,
        choices=(PRINTED, KNOWN),
    )

    def parts(
        self, run: KnownSettings, model: TransmissionModel | None = None, *, noise_rpm: float = 1.0
    ) -> tuple[TransmissionModel, Observer]:
        """
        Return the model with its known inputs, and its filter.

        `model` replaces the model of the run's driveline; `noise_rpm` is the noise of w_d in rpm
        where it is the only measured signal.
        """
        if model is None:
            scenario = run.scenario
            actuator = scenario.actuator if self.actuator_in_model == KNOWN else PRINTED_ACTUATOR
            if not self.delay_in_model:
                actuator = replace(actuator, delay_s=0.0)
            model = transmission_model(scenario.controlled_driveline, actuator=actuator)
        known = model if self.load_known else model.without_load
        if self.measured == 'slip':
            return known, Observer(known, unit_noise_gain(known, noise_rpm), start=None)
        return known, make_observer(run, model, load_known=self.load_known)


AS_DRAWN = ObserverInputs(
    'slip', load_known=False, delay_in_model=False, actuator_in_model=PRINTED
)
"""Inputs of Figure 4.2: mo is w_d, md is C_m; the plant of Section 3.2.1.3 is P_2 G_a."""
FULL = ObserverInputs('speeds', load_known=True, delay_in_model=True, actuator_in_model=KNOWN)
"""All signals that are measured in a car, and the complete model of the plant."""


@dataclass(frozen=True)
class DisturbanceObserver(OptionGroup):
    """Filter that estimates constant errors of C_f and C_load too."""

    clutch_drift_n_m: float | None = option(
        None,
        'drift of the error of C_f, per period',
        'N m',
        otherwise=OF_CLUTCH,
        above=0.0,
        at_most=MOST,
    )
    load_drift_n_m: float | None = option(
        None,
        'drift of the error of C_load, per period',
        'N m',
        otherwise=OF_LOAD,
        above=0.0,
        at_most=MOST,
    )

    def parts(self, run: KnownSettings) -> tuple[TransmissionModel, Observer]:
        """Return the model with both errors as its states, and its filter."""
        drift = Drifts.of(run.scenario, self.clutch_drift_n_m, self.load_drift_n_m)
        noise = NoiseLevels(drift=drift)
        model = offset_free_model(run.scenario.controlled_driveline, run.scenario.actuator)
        return model, make_observer(run, model, noise)


@dataclass(frozen=True)
class WearEstimate(WearNoise):
    """Filter that estimates the wear of the clutch, with the model of a new one."""

    def parts(self, run: KnownSettings) -> tuple[TransmissionModel, WearObserver]:
        """Return the model with the errors of C_f and C_load, and its filter."""
        model = offset_free_model(run.scenario.controlled_driveline, run.scenario.actuator)
        drifts = Drifts.of(run.scenario, self.clutch_drift_n_m, self.load_drift_n_m)
        return model, WearObserver(model, NoiseLevels(), self, drifts, run_start(run))
