# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Try whether controllers of any class are what their `linear_model` says."""

from collections.abc import Sequence
from functools import partial

import numpy as np

from ddct_controllers.interface import Controller, Measurement
from ddct_controllers.linear import DiscreteFilter, LinearController, PiController
from ddct_plant.base.errors import FOREIGN_FAILURES
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace
from ddct_plant.program.own_process import ProcessEndedError, in_own_process

_STEPS = 60
_STEPS_APART = 17
"""Number of steps from one measurement of a trial to the next, so that it covers 10 s."""
_TOLERANCE = 1e-11
"""
Largest difference between `update` of a class and its model, relative to the largest torque.
"""


def is_known_linear(controller: Controller) -> bool:
    """Return whether a controller is of a class that needs no trial."""
    return type(controller) in (LinearController, PiController)


def why_not_linear(controllers: Sequence[Controller]) -> list[str]:
    """
    Return in one line why each of these controllers is not its model, empty if it is.

    Those of other packages are tried in a process of their own: they may end it, or take too long.
    """
    foreign = [each for each in controllers if not _is_ours(each)]
    apart = iter(_why_apart(foreign))
    return [_why(each) if _is_ours(each) else next(apart) for each in controllers]


def _is_ours(controller: Controller) -> bool:
    package, _, _ = type(controller).__module__.partition('.')
    return package == Controller.__module__.partition('.')[0]


def _why_apart(controllers: Sequence[Controller]) -> list[str]:
    """Return the same from one process, or where that fails from one for each controller."""
    try:
        return in_own_process(partial(_each_why, controllers)) if controllers else []
    except ProcessEndedError as error:
        if len(controllers) == 1:
            return [f'its process failed when the controller was tried: {error}']
        return [why for each in controllers for why in _why_apart([each])]


def _each_why(controllers: Sequence[Controller]) -> list[str]:
    return [_why(each) for each in controllers]


def _why(controller: Controller) -> str:
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


def _matches_model(controller: Controller, model: object) -> bool:
    """
    Return whether the controller and its model give equal outputs for random measurements.

    The measurements grow up to very large values, so that a saturation shows.
    """
    if not isinstance(model, StateSpace) or model.d.shape != (1, 1) or model.period_s != PERIOD_S:
        return False
    random, filtered = np.random.default_rng(0), DiscreteFilter(model)
    largest = worst = 0.0
    for step in range(_STEPS):
        played = _measurement(random, step, controller.preview_steps)
        torque = filtered.update(played.slip_error_rpm)
        largest = max(largest, abs(torque))
        worst = max(worst, abs(controller.update(played).clutch_torque - torque))
    return bool(worst <= _TOLERANCE * largest or worst == 0.0)


def _measurement(random: np.random.Generator, step: int, preview_steps: int) -> Measurement:
    """Return random speeds, torques and references without relation; they grow with the step."""
    size = 10.0 ** (3.0 * step / _STEPS)
    values = random.normal(scale=size, size=7).tolist()
    references = random.normal(scale=size, size=(2, preview_steps + 1)).tolist()
    return Measurement(_STEPS_APART * step, *values[:5], *references, *values[5:])
