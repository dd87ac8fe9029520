# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Linear feedback on the slip error: G_c(z) in state-space form, and the PI with its gains."""

import dataclasses
from collections.abc import Mapping
from functools import lru_cache

import numpy as np

from ddct_controllers.interface import (
    Command,
    Controller,
    ControllerSpec,
    Measurement,
)
from ddct_plant.base.errors import ParameterError, require_choice
from ddct_plant.base.options import Option
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.bilinear import from_w_plane
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.linear.sampling import discretise_zoh

HOLD, BILINEAR = 'hold', 'bilinear'
"""
Discretisations at 10 ms: zero-order hold as the thesis's `c2d`, or the bilinear rule.

The latter is z = (1 + s T/2) / (1 - s T/2).
"""
LinearSystem = FactoredTransferFunction | StateSpace
"""A linear system in the form in which its author wrote it."""
PI_OPTIONS = {
    'proportional_gain': Option(
        0.103,
        'K_p: torque per slip error',
        'N m/rpm',
        source='fitted to the PI row of Table 5.1',
        at_least=0.0,
        at_most=1e3,
        live=True,
    ),
    'integral_gain': Option(
        0.0223,
        'K_i: torque per slip error and second',
        'N m/(rpm s)',
        source='fitted to the PI row of Table 5.1',
        at_least=0.0,
        at_most=1e3,
        live=True,
    ),
}


def sampled(controller: LinearSystem, discretisation: str | None = None) -> StateSpace:
    """
    Return G_c(z) at 10 ms of a continuous G_c(s), or a system that is sampled so unchanged.

    HOLD, the default for a transfer function, gives the printed G_c(z) (Sections 2.2, 3.2).
    BILINEAR keeps the phase of a design that had hold and delay in its plant. Raise ParameterError
    for more than one input or output, another period, a continuous state space without a
    discretisation, an improper transfer function or, with BILINEAR, a pole at 2/T.
    """
    if isinstance(controller, FactoredTransferFunction):
        return _sampled_factors(controller, discretisation or HOLD)
    return _sampled_state_space(controller, discretisation)


@lru_cache
def _sampled_factors(controller: FactoredTransferFunction, discretisation: str) -> StateSpace:
    # Each run of a campaign asks for those of the printed controllers.
    return _sampled_state_space(controller.to_state_space(), discretisation)


def _sampled_state_space(controller: StateSpace, discretisation: str | None) -> StateSpace:
    if discretisation is not None:
        require_choice('discretisation', discretisation, (HOLD, BILINEAR))
    periods = (PERIOD_S,) if discretisation is None else (PERIOD_S, None)
    if controller.period_s not in periods or controller.d.shape != (1, 1):
        raise ParameterError(
            f'linear controller: a state space must have one input, one output and a period '
            f'of {PERIOD_S} s',
            key='state space',
        )
    if controller.period_s is not None:
        return controller
    rule = discretise_zoh if discretisation == HOLD else from_w_plane
    try:
        with np.errstate(over='ignore', invalid='ignore'):
            return rule(controller, PERIOD_S)
    except np.linalg.LinAlgError as error:
        raise ParameterError(
            f'linear controller: it has a pole at {2.0 / PERIOD_S:g} rad/s, for which '
            f'{BILINEAR} has no value: move it, or choose {HOLD}'
        ) from error
    except ParameterError as error:
        raise ParameterError(
            f'linear controller: within {PERIOD_S:g} s it grows beyond all numbers: its unstable '
            'poles are too fast'
        ) from error


def in_z(form: LinearSystem) -> StateSpace:
    """Return G_c(z) at 10 ms of a form whose variable is z already."""
    if isinstance(form, FactoredTransferFunction):
        form = form.to_state_space()
    return dataclasses.replace(form, period_s=PERIOD_S)


class DiscreteFilter:
    """y_k = c x_k + d u_k, x_(k+1) = a x_k + b u_k, with one output and any number of inputs."""

    def __init__(self, model: StateSpace) -> None:
        """Start at x = 0."""
        self._state_update = np.hstack([model.a, model.b])
        self._output = np.hstack([model.c, model.d])[0]
        self._states = len(model.a)
        self._state_and_inputs = np.zeros(len(self._output))

    def reset(self, state: np.ndarray | float = 0.0) -> None:
        """Set x to `state`, (n,), by default zero."""
        self._state_and_inputs[: self._states] = state

    def update(self, *inputs: float) -> float:
        """Return the output of this period and advance the state to the next one."""
        values = self._state_and_inputs
        values[self._states :] = inputs
        output = float(self._output @ values)
        values[: self._states] = self._state_update @ values
        return output


class LinearController(Controller):
    """u = G_c e with e in rpm and u in N m, sampled at 10 ms."""

    def __init__(self, controller: LinearSystem, discretisation: str | None = None) -> None:
        """Discretise G_c(s), or use G_c(z); raise ParameterError as `sampled` does."""
        self._model = sampled(controller, discretisation)
        self._filter = DiscreteFilter(self._model)
        self.given, self.discretisation = controller, discretisation

    def reset(self) -> None:
        """Set the state to zero."""
        self._filter.reset()

    def update(self, measurement: Measurement) -> Command:
        """Return C_f = C x + D e and advance x by A x + B e."""
        return Command(self._filter.update(measurement.slip_error_rpm))

    def linear_model(self) -> StateSpace:
        """Return G_c(z)."""
        return self._model


def linear_spec(
    name: str,
    controller: LinearSystem,
    discretisation: str | None = None,
) -> ControllerSpec[Controller]:
    """Return the specification of a linear controller called `name`, without options."""
    return ControllerSpec(name, lambda context: LinearController(controller, discretisation), {})


class PiController(Controller):
    """
    u = -(K_p e + K_i integral of e) with e in rpm and u in N m.

    G_c(s) = -(K_p + K_i/s) by zero-order hold: the preliminary controller that the thesis compares
    against (Section 1.4.5.1). It prints no gains: those of its scenario are calibrated.
    """

    def __init__(self, proportional_gain: float, integral_gain: float) -> None:
        """Take K_p in N m/rpm and K_i in N m/(rpm s), neither negative."""
        self._gains: dict[str, float] = {}
        self.set_gain('proportional_gain', proportional_gain)
        self.set_gain('integral_gain', integral_gain)
        self._integral_rpm_s = 0.0

    def reset(self) -> None:
        """Set the integral to zero."""
        self._integral_rpm_s = 0.0

    def update(self, measurement: Measurement) -> Command:
        """Return the torque of this period; the error is added to the integral afterwards."""
        error_rpm = measurement.slip_error_rpm
        torque = -(
            self._gains['proportional_gain'] * error_rpm
            + self._gains['integral_gain'] * self._integral_rpm_s
        )
        self._integral_rpm_s += PERIOD_S * error_rpm
        return Command(torque)

    def linear_model(self) -> StateSpace:
        """Return -(K_p + K_i T / (z - 1)); its state is the integral of the error."""
        proportional, integral = (np.array([[-self._gains[name]]]) for name in PI_OPTIONS)
        one = np.ones((1, 1))
        return StateSpace(one, PERIOD_S * one, integral, proportional, PERIOD_S)

    def gains(self) -> Mapping[str, float]:
        """Return K_p and K_i."""
        return dict(self._gains)

    def set_gain(self, name: str, value: float) -> None:
        """Change K_p or K_i from the next update on; the integral of the error is kept."""
        if name not in PI_OPTIONS:
            raise ParameterError(
                f'pi has no gain {name!r}: it has {", ".join(PI_OPTIONS)}', key=name
            )
        self._gains[name] = PI_OPTIONS[name].checked(f'controllers.pi.{name}', value)


PI = ControllerSpec('pi', lambda context: PiController(**context.gains), PI_OPTIONS)
