# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Decide which runs can be computed in a batch, and find their linear feedback."""

import dataclasses

import numpy as np

from ddct_controllers.interface import Controller, Measurement
from ddct_controllers.linear import DiscreteFilter, LinearController, PiController
from ddct_plant.base.errors import FOREIGN_FAILURES
from ddct_plant.base.options import key_of
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace
from ddct_plant.scenario.control import ENGINE_SPEED_TARGET
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SUPPORTED_KEYS = frozenset(
    {
        *('name', 'description', 'duration_s', 'control_start_s', 'score_window_s', 'equilibrium'),
        *('clutch',),
        *('engine', 'initial', 'reference', 'slip_reference', 'slope', 'load', 'vehicle'),
        *('driveline', 'actuator', 'controllers', 'gear', 'gearbox', 'adjusted'),
        *('engine_authority', 'engine_speed_reference', 'pedal_position'),
    }
)
"""Scenario keys that a batch supports, or that have no effect with a linear controller."""
_UNSUPPORTED = [
    (field.name, field.default)
    for field in dataclasses.fields(Scenario)
    if key_of(field) not in SUPPORTED_KEYS
]
"""Other scenario keys, with their defaults."""
_TRIAL_STEPS = 60
_MODEL_TOLERANCE = 1e-11
"""
Largest difference between `update` of a foreign class and its model, relative to the largest
torque.
"""


def why_not_batchable(settings: RunSettings, controller: Controller) -> str:
    """
    Return in one line why a run cannot be computed in a batch, empty if it can.

    The controller is not changed except for a reset.
    """
    return (
        _why_not_scenario(settings.scenario)
        or _why_not_known(settings.known)
        or _why_not_controller(controller)
    )


def _why_not_known(known: KnownSettings) -> str:
    if known.stick_slip:
        return f'the clutch is {known.clutch}'
    if not known.lockstep:
        return f'the mode is {known.mode}'
    if known.reference_shape == ENGINE_SPEED_TARGET:
        return f'reference.shape is {ENGINE_SPEED_TARGET}'
    return _why_not_scenario(known.scenario)


def _why_not_scenario(scenario: Scenario) -> str:
    for name, default in _UNSUPPORTED:
        if getattr(scenario, name) != default:
            return f'the scenario gives {name}'
    return ''


def _why_not_controller(controller: Controller) -> str:
    if controller.commands_engine:
        return 'the controller commands the engine'
    kind = type(controller)
    if kind.hold is not Controller.hold:
        return 'the controller does more than reset while feedback is held off'
    if _is_packaged(kind):
        return ''
    try:
        model = controller.linear_model()
        if model is None:
            return 'the controller is not linear'
        controller.reset()
        same = _matches_model(controller, model)
        controller.reset()
    except FOREIGN_FAILURES as error:
        return f'the controller failed when it was tried ({type(error).__name__}: {error})'
    return '' if same else 'the controller does not do what its linear_model says'


def _is_packaged(kind: type[Controller]) -> bool:
    """Return whether `update` and `linear_model` belong to one packaged class and so agree."""
    return any(
        kind.update is ours.update and kind.linear_model is ours.linear_model
        for ours in (LinearController, PiController)
    )


def _matches_model(controller: Controller, model: object) -> bool:
    """
    Return whether the controller and its model give equal outputs for random measurements.

    The measurements grow up to very large values, so that a saturation shows.
    """
    if not isinstance(model, StateSpace) or model.d.shape != (1, 1) or model.period_s != PERIOD_S:
        return False
    random, filtered = np.random.default_rng(0), DiscreteFilter(model)
    largest = worst = 0.0
    for step in range(_TRIAL_STEPS):
        played = _measurement(random, step, controller.preview_steps)
        torque = filtered.update(played.slip_error_rpm)
        largest = max(largest, abs(torque))
        worst = max(worst, abs(controller.update(played).clutch_torque - torque))
    return bool(worst <= _MODEL_TOLERANCE * largest or worst == 0.0)


def _measurement(random: np.random.Generator, step: int, preview_steps: int) -> Measurement:
    """Return random speeds, torques and references without relation; they grow with the step."""
    size = 10.0 ** (3.0 * step / _TRIAL_STEPS)
    values = random.normal(scale=size, size=7).tolist()
    references = random.normal(scale=size, size=(2, preview_steps + 1)).tolist()
    return Measurement(step, *values[:5], *references, *values[5:])
