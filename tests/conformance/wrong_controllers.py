# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers with one beginner's error each, otherwise a sound proportional controller."""

import random
import sys
import time
from time import monotonic
from typing import Any, ClassVar

import numpy as np

from ddct_controllers.interface import Command, Controller, ControllerContext, Measurement
from ddct_plant.base.options import Option, Options
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace

GAIN = 0.1
"""Gain in N m/rpm; the loop crosses over at about 4 rad/s."""


class Proportional(Controller):
    """The sound controller, which the others change in one place."""

    options: ClassVar[Options | None] = {}

    def __init__(self, context: ControllerContext) -> None:
        pass

    def reset(self) -> None:
        pass

    def update(self, measurement: Measurement) -> Command:
        return Command(-GAIN * measurement.slip_error_rpm)


class WrongType(Proportional):
    def update(self, measurement: Measurement) -> Any:
        return -GAIN * measurement.slip_error_rpm


class NoAnswer(Proportional):
    def update(self, measurement: Measurement) -> Any:
        Command(-GAIN * measurement.slip_error_rpm)


class NotANumber(Proportional):
    def update(self, measurement: Measurement) -> Command:
        slip = np.float64(measurement.slip_reference[0])
        with np.errstate(invalid='ignore'):
            relative = (slip - slip) / np.float64(0.0)
        return Command(float(-GAIN * relative))


class AnArray(Proportional):
    def update(self, measurement: Measurement) -> Command:
        torque: Any = np.array([[-GAIN]]) @ np.array([measurement.slip_error_rpm])
        return Command(torque)


class MissingReset(Proportional):
    def __init__(self, context: ControllerContext) -> None:
        self._integral = 0.0

    def update(self, measurement: Measurement) -> Command:
        self._integral += 0.01 * measurement.slip_error_rpm
        return Command(-GAIN * (measurement.slip_error_rpm + 0.2 * self._integral))


class NoReset(Controller):
    def __init__(self, context: ControllerContext) -> None:
        pass

    def update(self, measurement: Measurement) -> Command:
        return Command(-GAIN * measurement.slip_error_rpm)


class SharedState(Proportional):
    errors: ClassVar[list[float]] = []

    def reset(self) -> None:
        pass

    def update(self, measurement: Measurement) -> Command:
        self.errors.append(measurement.slip_error_rpm)
        return Command(-GAIN * (self.errors[-1] + 0.002 * sum(self.errors)))


class Slow(Proportional):
    def update(self, measurement: Measurement) -> Command:
        time.sleep(0.012)
        return super().update(measurement)


class WrongSign(Proportional):
    def update(self, measurement: Measurement) -> Command:
        return Command(GAIN * measurement.slip_error_rpm)


class RadiansTakenForRpm(Proportional):
    """A controller whose gain is meant for rpm, with an error in rad/s."""

    def update(self, measurement: Measurement) -> Command:
        return Command(-GAIN * (measurement.slip_reference[0] - measurement.slip_speed))


class RpmTwice(Proportional):
    """A controller whose error is in rpm already, and is converted once more."""

    def update(self, measurement: Measurement) -> Command:
        return Command(-GAIN * measurement.slip_error_rpm * 30.0 / np.pi)


class FailsToBuild(Proportional):
    def __init__(self, context: ControllerContext) -> None:
        self._inverse = np.linalg.inv(np.zeros((2, 2)))


class FailsInUpdate(Proportional):
    def update(self, measurement: Measurement) -> Command:
        ahead = measurement.slip_reference[5]
        return Command(-GAIN * (ahead - measurement.slip_speed))


class WrongStatus(Proportional):
    def update(self, measurement: Measurement) -> Command:
        status: Any = {'error_rpm': measurement.slip_error_rpm}
        return Command(-GAIN * measurement.slip_error_rpm, status)


class UnknownGain(Proportional):
    options: ClassVar[Options | None] = {'gain': Option(GAIN, 'K_p', 'N m/rpm', at_least=0.0)}

    def __init__(self, context: ControllerContext) -> None:
        self._gain = context.gains.get('gian', GAIN)


class UndeclaredGain(Proportional):
    options: ClassVar[Options | None] = None

    def __init__(self, context: ControllerContext) -> None:
        self._gain = context.gains.get('gain', GAIN)


class RandomNumbers(Proportional):
    def update(self, measurement: Measurement) -> Command:
        return Command(-GAIN * measurement.slip_error_rpm + random.gauss(0.0, 0.1))


class WallClock(Proportional):
    def __init__(self, context: ControllerContext) -> None:
        self.reset()

    def reset(self) -> None:
        self._last, self._integral = time.monotonic(), 0.0

    def update(self, measurement: Measurement) -> Command:
        now = time.monotonic()
        self._integral += (now - self._last) * measurement.slip_error_rpm
        self._last = now
        return Command(-GAIN * (measurement.slip_error_rpm + 0.2 * self._integral))


class SharedIntegral(Proportional):
    """A controller whose state belongs to the class, but is cleared by reset."""

    integral = 0.0

    def reset(self) -> None:
        SharedIntegral.integral = 0.0

    def update(self, measurement: Measurement) -> Command:
        SharedIntegral.integral += 0.01 * measurement.slip_error_rpm
        return Command(-GAIN * (measurement.slip_error_rpm + 0.2 * self.integral))


class SharedDefault(Proportional):
    """A controller whose list is made once, when the method is defined."""

    def update(self, measurement: Measurement, errors: list[float] = []) -> Command:  # noqa: B006
        errors.append(measurement.slip_error_rpm)
        return Command(-GAIN * (errors[-1] + 0.002 * sum(errors)))


class ClockOfItsOwn(Proportional):
    """A controller with the clock's name bound in its own module, read in whole hours."""

    def update(self, measurement: Measurement) -> Command:
        return Command(-GAIN * measurement.slip_error_rpm - monotonic() // 3600.0)


class HidesNaN(Proportional):
    """A controller whose limit turns NaN into a torque."""

    def __init__(self, context: ControllerContext) -> None:
        self.reset()

    def reset(self) -> None:
        self._integral = 0.0

    def update(self, measurement: Measurement) -> Command:
        self._integral += 0.01 * measurement.slip_error_rpm
        wanted = -GAIN * (measurement.slip_error_rpm + 0.2 * self._integral)
        return Command(max(-100.0, min(100.0, wanted)))


class Chatters(Proportional):
    """A controller that switches to and fro at every step."""

    def update(self, measurement: Measurement) -> Command:
        switched = 30.0 if measurement.step % 2 else -30.0
        return Command(switched - GAIN * measurement.slip_error_rpm)


class IdlePreview(Proportional):
    preview_steps = 5


class AnotherModel(Proportional):
    """A controller whose linear_model has the sign of the plant in it."""

    def linear_model(self) -> StateSpace:
        none = np.zeros((0, 0))
        return StateSpace(none, np.zeros((0, 1)), np.zeros((1, 0)), np.array([[GAIN]]), PERIOD_S)


class Prints(Proportional):
    def update(self, measurement: Measurement) -> Command:
        print('e =', measurement.slip_error_rpm)
        return super().update(measurement)


class WritesItsInput(Proportional):
    """A controller that would replace the reference against which the run is scored."""

    def update(self, measurement: Measurement) -> Command:
        measurement.slip_reference[0] = measurement.slip_speed  # type: ignore[index]
        return super().update(measurement)


class Leaves(Proportional):
    def update(self, measurement: Measurement) -> Command:
        sys.exit(3)
