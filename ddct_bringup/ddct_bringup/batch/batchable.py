# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Decide which runs can be computed in a batch, and find the kind of their controllers."""

import dataclasses

from ddct_bringup.batch.controllers.interface import StackedController
from ddct_bringup.batch.controllers.least_jerk.controllers import LeastJerkControllers
from ddct_bringup.batch.controllers.linear import LinearControllers
from ddct_bringup.batch.controllers.predictive import PredictiveControllers
from ddct_bringup.batch.controllers.trial import is_known_linear
from ddct_bringup.batch.handovers.choice import why_no_handover
from ddct_bringup.batch.references import why_no_reference
from ddct_controllers.interface import Controller
from ddct_plant.base.options import key_of
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SUPPORTED_KEYS = frozenset(
    {
        *('name', 'description', 'duration_s', 'control_start_s', 'score_window_s', 'equilibrium'),
        *('clutch', 'friction', 'heat', 'brake', 'engine_limits', 'closing', 'sensors'),
        *('engine', 'initial', 'reference', 'slip_reference', 'slope', 'load', 'vehicle'),
        *('driveline', 'actuator', 'controllers', 'gear', 'gearbox', 'adjusted'),
        *('engine_authority', 'engine_speed_reference', 'pedal_position', 'shift'),
    }
)
"""Scenario keys that a batch supports, or that have no effect in it."""
_UNSUPPORTED = [
    (field.name, field.default)
    for field in dataclasses.fields(Scenario)
    if key_of(field) not in SUPPORTED_KEYS
]
"""Other scenario keys, with their defaults."""
_KINDS: tuple[type[StackedController], ...] = (
    PredictiveControllers,
    LeastJerkControllers,
    LinearControllers,
)
"""Kinds of controllers that a batch supports; the first that takes a controller is its own."""


def why_not_batchable(settings: RunSettings, controller: Controller) -> str:
    """
    Return in one line why a run cannot be computed in a batch, empty if it can.

    One whose controller `needs_trial` can if `why_not_linear` has no reason either.
    """
    return (
        _why_not_scenario(settings.scenario)
        or _why_not_known(settings.known)
        or _why_not_controller(controller)
    )


def needs_trial(controller: Controller) -> bool:
    """Return whether only a trial says that a controller is what the batch takes it for."""
    return kind_of(controller) is LinearControllers and not is_known_linear(controller)


def kind_of(controller: Controller) -> type[StackedController]:
    """Return the kind of a controller, if a batch supports it."""
    return next(kind for kind in _KINDS if kind.takes(controller))


def _why_not_known(known: KnownSettings) -> str:
    if not known.lockstep:
        return f'the mode is {known.mode}'
    if known.shift and (reason := why_no_handover(known)):
        return reason
    return why_no_reference(known) or _why_not_scenario(known.scenario)


def _why_not_scenario(scenario: Scenario) -> str:
    for name, default in _UNSUPPORTED:
        if getattr(scenario, name) != default:
            return f'the scenario gives {name}'
    return ''


def _why_not_controller(controller: Controller) -> str:
    if controller.commands_engine:
        return 'the controller commands the engine'
    return kind_of(controller).why_not(controller)
