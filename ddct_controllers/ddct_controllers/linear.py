"""Linear feedback on the slip error: a discrete transfer function G_c(z) in state-space form."""

import dataclasses

import numpy as np

from ddct_controllers.interface import (
    UNSTATED,
    Command,
    Controller,
    ControllerSpec,
    Measurement,
)
from ddct_plant.base.errors import ParameterError, require_choice
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.bilinear import from_w_plane
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace, discretise_zoh

HOLD, BILINEAR = 'hold', 'bilinear'
"""Zero-order hold as the thesis's `c2d`, or z = (1 + s T/2) / (1 - s T/2), both at 10 ms."""
Given = FactoredTransferFunction | StateSpace
"""A linear system as its author wrote it."""


def sampled(controller: Given, discretisation: str | None = None) -> StateSpace:
    """
    Return G_c(z) at 10 ms of a continuous G_c(s); one that is sampled so is returned as it is.

    HOLD, the default for a transfer function, gives the printed G_c(z) (Sections 2.2, 3.2).
    BILINEAR keeps the phase of a design that had hold and delay in its plant. Raise ParameterError
    for more than one input or output, another period, a continuous state space without a
    discretisation, an improper transfer function or, with BILINEAR, a pole at 2/T.
    """
    if isinstance(controller, FactoredTransferFunction):
        controller, discretisation = controller.to_state_space(), discretisation or HOLD
    if discretisation is not None:
        require_choice('discretisation', discretisation, (HOLD, BILINEAR))
    periods = (PERIOD_S,) if discretisation is None else (PERIOD_S, None)
    if controller.period_s not in periods or controller.d.shape != (1, 1):
        raise ParameterError(
            f'linear controller: a state space must have one input, one output and a period '
            f'of {PERIOD_S} s'
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


def in_z(form: Given) -> StateSpace:
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

    def __init__(self, controller: Given, discretisation: str | None = None) -> None:
        """Discretise G_c(s), or take G_c(z); raise ParameterError as `sampled` does."""
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
    controller: Given,
    discretisation: str | None = None,
    computed_from: str = UNSTATED,
) -> ControllerSpec[Controller]:
    """Return how the linear controller called `name`, which takes no options, is made."""
    return ControllerSpec(
        name, lambda context: LinearController(controller, discretisation), {}, computed_from
    )
