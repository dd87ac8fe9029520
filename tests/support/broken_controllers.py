# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Third parties' controllers, each with one defect."""

import math
import time
from typing import Any

from ddct_controllers.interface import (
    Command,
    Controller,
    ControllerContext,
    ControllerSpec,
    Measurement,
)
from ddct_plant.base.options import Option


class _Broken(Controller):
    def __init__(self, answer: Any, good_until_step: float = 0) -> None:
        self._answer = answer
        self._good_until_step = good_until_step

    def reset(self) -> None:
        pass

    def update(self, measurement: Measurement) -> Command:
        if measurement.step < self._good_until_step:
            return Command(0.0)
        if isinstance(self._answer, BaseException):
            raise self._answer
        return self._answer


def _make_not_a_number(context: ControllerContext) -> Controller:
    return _Broken(Command(math.nan), context.gains['good_until_step'])


make_not_a_number = ControllerSpec(
    'not_a_number', _make_not_a_number, {'good_until_step': Option(0, 'first step with NaN')}
)
"""Controller that commands NaN from the step in its option `good_until_step` on."""


def make_infinite(context: ControllerContext) -> Controller:
    """Return a controller that commands an infinite torque."""
    return _Broken(Command(math.inf))


def make_bare_number(context: ControllerContext) -> Controller:
    """Return a controller that returns a number instead of a Command."""
    return _Broken(12.5)


def make_text(context: ControllerContext) -> Controller:
    """Return a controller whose torque is text."""
    torque: Any = '12.5'
    return _Broken(Command(torque))


def make_bad_status(context: ControllerContext) -> Controller:
    """Return a controller whose status is no text."""
    status: Any = (('iterations', 3),)
    return _Broken(Command(1.0, status))


def make_bad_linear_model(context: ControllerContext) -> Controller:
    """Return a controller whose linear model is none."""
    controller = _Broken(Command(1.0))
    controller.linear_model = lambda: [[1.0]]  # type: ignore[assignment, method-assign, return-value]
    return controller


def make_raising(context: ControllerContext) -> Controller:
    """Return a controller that divides by zero."""
    return _Broken(ZeroDivisionError('float division by zero'))


def make_leaving(context: ControllerContext) -> Controller:
    """Return a controller that would end the program."""
    return _Broken(SystemExit(3))


class _Slow(_Broken):
    def update(self, measurement: Measurement) -> Command:
        time.sleep(0.011)
        return super().update(measurement)


def make_slow(context: ControllerContext) -> Controller:
    """Return a controller whose updates outlast their period."""
    return _Slow(Command(0.0))


def make_no_controller(context: ControllerContext) -> object:
    """Return something that is no controller."""
    return {'gain': 1.0}


def make_nothing(context: ControllerContext) -> Controller:
    """Fail to build a controller."""
    raise KeyError('gain')
