# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers that differ from each other and are all in order."""

import time
from collections import deque
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from ddct_controllers.interface import Command, Controller, ControllerContext, Measurement
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.base.options import Option, Options
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.linear.lti import StateSpace

GAIN = Option(0.1, 'K_p', 'N m/rpm', at_least=0.0, at_most=0.5)


class NoIntegrator(Controller):
    """A proportional controller."""

    options: ClassVar[Options] = {'gain': GAIN}

    def __init__(self, context: ControllerContext) -> None:
        self._gain = context.gains['gain']

    def reset(self) -> None:
        pass

    def update(self, measurement: Measurement) -> Command:
        return Command(-self._gain * measurement.slip_error_rpm)

    def linear_model(self) -> StateSpace | None:
        none = np.zeros((0, 0))
        return StateSpace(
            none, np.zeros((0, 1)), np.zeros((1, 0)), np.array([[-self._gain]]), PERIOD_S
        )


class TwoMethods(Controller):
    """A controller with neither options nor state, so without a constructor."""

    def reset(self) -> None:
        pass

    def update(self, measurement: Measurement) -> Command:
        return Command(-0.1 * measurement.slip_error_rpm)


class Soft(NoIntegrator):
    """A controller of a quarter of the gain: slow, but within the engagement."""

    def update(self, measurement: Measurement) -> Command:
        return Command(-0.4 * self._gain * measurement.slip_error_rpm)

    def linear_model(self) -> None:
        return None


class TwoInputs(Controller):
    """A controller with two inputs, each with half of the torque against slip."""

    options: ClassVar[Options] = {'gain': GAIN}
    commands_engine = True

    def __init__(self, context: ControllerContext) -> None:
        self._half = 0.5 * context.gains['gain']

    def reset(self) -> None:
        pass

    def update(self, measurement: Measurement) -> Command:
        torque = -self._half * measurement.slip_error_rpm
        return Command(torque, engine_torque=measurement.engine_torque - torque)


class EngineAlone(TwoInputs):
    """A controller that acts against slip by the engine only."""

    def update(self, measurement: Measurement) -> Command:
        torque = -2.0 * self._half * measurement.slip_error_rpm
        return Command(0.0, engine_torque=measurement.engine_torque - torque)


class Preview(NoIntegrator):
    """A controller of the error to the reference 50 ms ahead."""

    preview_steps = 5

    def update(self, measurement: Measurement) -> Command:
        ahead_rpm = rpm_from_rad_s(measurement.slip_reference[5] - measurement.slip_speed)
        return Command(-self._gain * ahead_rpm, (('ahead_rpm', f'{ahead_rpm:.3f}'),))

    def linear_model(self) -> None:
        return None


class SlowStart(Controller):
    """A controller whose gain rises over 0.3 s; its first update builds a table."""

    options: ClassVar[Options] = {'gain': GAIN, 'rise_s': Option(0.3, 'rise time', 's', above=0.0)}

    def __init__(self, context: ControllerContext) -> None:
        self._gain, self._rise_s = context.gains['gain'], context.gains['rise_s']
        self._table: np.ndarray | None = None
        self.reset()

    def reset(self) -> None:
        self._steps = 0

    def update(self, measurement: Measurement) -> Command:
        if self._table is None:
            time.sleep(0.05)
            self._table = np.linspace(0.0, 1.0, 31)
        share = float(np.interp(self._steps * PERIOD_S / self._rise_s, self._table, self._table))
        self._steps += 1
        return Command(-share * self._gain * measurement.slip_error_rpm)


class OwnObserver(Controller):
    """A controller that estimates the slip's rate, with a filter that always runs."""

    options: ClassVar[Options] = {
        'gain': GAIN,
        'rate_gain': Option(0.005, 'K_d', 'N m/(rpm/s)', at_least=0.0),
    }

    def __init__(self, context: ControllerContext) -> None:
        self._gains: Mapping[str, float] = dict(context.gains)
        self.reset()

    def reset(self) -> None:
        self._slip: float | None = None
        self._rate = 0.0

    def hold(self, measurement: Measurement) -> None:
        self._follow(measurement)

    def update(self, measurement: Measurement) -> Command:
        self._follow(measurement)
        rate_error = rpm_from_rad_s(measurement.slip_reference_rate[0] - self._rate)
        proportional = self._gains['gain'] * measurement.slip_error_rpm
        return Command(-proportional - self._gains['rate_gain'] * rate_error)

    def _follow(self, measurement: Measurement) -> None:
        slip = measurement.slip_speed
        if self._slip is not None:
            self._rate += 0.2 * ((slip - self._slip) / PERIOD_S - self._rate)
        self._slip = slip


class GainScheduled(Controller):
    """A controller with less gain at high slip."""

    options: ClassVar[Options] = {
        'gains': Option((0.12, 0.06), 'K_p at no slip and from 100 rad/s on', many=True)
    }

    def __init__(self, context: ControllerContext) -> None:
        self._low, self._high = context.gains['gains']

    def reset(self) -> None:
        pass

    def update(self, measurement: Measurement) -> Command:
        share = min(abs(measurement.slip_speed) / 100.0, 1.0)
        gain = self._low + share * (self._high - self._low)
        return Command(-gain * measurement.slip_error_rpm)


class AntiWindup(Controller):
    """A PI limited to the clutch's torque, with a gain that may be changed as it runs."""

    options: ClassVar[Options] = {
        'gain': Option(0.1, 'K_p', 'N m/rpm', at_least=0.0, live=True),
        'most': Option(200.0, 'largest torque', 'N m', above=0.0),
    }

    def __init__(self, context: ControllerContext) -> None:
        self._gain, self._most = context.gains['gain'], context.gains['most']
        self.reset()

    def reset(self) -> None:
        self._integral = 0.0

    def update(self, measurement: Measurement) -> Command:
        error = measurement.slip_error_rpm
        if not abs(error) < 1e6:
            raise DdctError(f'slip error {error:g} rpm at step {measurement.step}')
        wanted = -self._gain * (error + 0.5 * self._integral)
        torque = min(max(wanted, -self._most), self._most)
        if torque == wanted:
            self._integral += PERIOD_S * error
        return Command(torque, (('limited', str(torque != wanted).lower()),))

    def gains(self) -> Mapping[str, float]:
        return {'gain': self._gain}

    def set_gain(self, name: str, value: float) -> None:
        if name != 'gain':
            raise ParameterError(f'no gain {name!r}: it has gain')
        self._gain = self.options['gain'].checked(name, value)


class DeadBand(Controller):
    """A controller inactive within 5 rpm, of a mean over 30 ms, with dither below 0.1 N m."""

    options: ClassVar[Options] = {'gain': GAIN}

    def __init__(self, context: ControllerContext) -> None:
        self._gain = context.gains['gain']
        self.reset()

    def reset(self) -> None:
        self._errors: deque[float] = deque(maxlen=3)
        self._random = np.random.default_rng(1)

    def update(self, measurement: Measurement) -> Command:
        self._errors.append(measurement.slip_error_rpm)
        error = sum(self._errors) / len(self._errors)
        beyond = error - min(max(error, -5.0), 5.0)
        return Command(-self._gain * beyond + 0.1 * float(self._random.random()))


def from_function(context: ControllerContext) -> Controller:
    """Return a controller from a factory that declares its options itself."""
    return NoIntegrator(context)


from_function.options = {'gain': GAIN}  # type: ignore[attr-defined]
