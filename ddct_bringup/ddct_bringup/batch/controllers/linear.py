# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Linear controllers of many runs, and whether a controller is linear throughout."""

from collections.abc import Hashable, Sequence
from typing import Self

import numpy as np

from ddct_bringup.batch.controllers.interface import Measured, StackedController
from ddct_bringup.batch.stacks import Filters
from ddct_controllers.interface import Controller, Measurement
from ddct_controllers.linear import DiscreteFilter, LinearController, PiController
from ddct_plant.base.errors import FOREIGN_FAILURES
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace
from ddct_plant.scenario.settings import KnownSettings

_TRIAL_STEPS = 60
_STEPS_APART = 17
"""Number of steps from one measurement of a trial to the next, so that it covers 10 s."""
_MODEL_TOLERANCE = 1e-11
"""
Largest difference between `update` of a foreign class and its model, relative to the largest
torque.
"""


class LinearControllers(StackedController):
    """Controllers that are their `linear_model`, all of one order; without feedback at rest."""

    def __init__(self, models: Sequence[StateSpace]) -> None:
        """Start at rest."""
        self._filters = Filters(models)

    @classmethod
    def takes(cls, controller: Controller) -> bool:
        """Return True: each class may have a `linear_model`."""
        return True

    @classmethod
    def why_not(cls, controller: Controller) -> str:
        """
        Return why a controller is not linear throughout, empty if it is.

        One of any class but the packaged two is tried and reset.
        """
        kind = type(controller)
        if kind.hold is not Controller.hold:
            return 'the controller does more than reset while feedback is held off'
        if kind in (LinearController, PiController):
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

    @classmethod
    def key(cls, controller: Controller) -> Hashable:
        """Return the order of the model."""
        return len(_model(controller).a)

    @classmethod
    def of(cls, controllers: Sequence[Controller], known: Sequence[KnownSettings]) -> Self:
        """Return the filters of the controllers' models."""
        models = {id(each): _model(each) for each in controllers}
        return cls([models[id(each)] for each in controllers])

    def update(self, measured: Measured) -> np.ndarray:
        """Return C x + D e of the slip errors e in rpm, and advance the states."""
        if not measured.on.any():
            self._filters.reset(~measured.on)
            return np.zeros(len(measured.on))
        torques = self._filters.update(measured.slip_error_rpm)
        if not measured.on.all():
            self._filters.reset(~measured.on)
            torques = np.where(measured.on, torques, 0.0)
        return torques


def _model(controller: Controller) -> StateSpace:
    model = controller.linear_model()
    assert model is not None, 'only linear controllers are of this kind'
    return model


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
    return Measurement(_STEPS_APART * step, *values[:5], *references, *values[5:])
