# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Linear controllers of many runs."""

from collections.abc import Hashable, Sequence
from typing import Self

import numpy as np

from ddct_bringup.batch.controllers.interface import Measured, StackedController
from ddct_bringup.batch.stacks import Filters
from ddct_controllers.interface import Controller
from ddct_plant.linear.lti import StateSpace
from ddct_plant.scenario.settings import KnownSettings


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
        """Return why its model is not all that it does; `why_not_linear` tries its steps."""
        if type(controller).hold is not Controller.hold:
            return 'the controller does more than reset while feedback is held off'
        return ''

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
