# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers from linear systems of other libraries: scipy.signal and python-control."""

from typing import Any

import numpy as np

from ddct_controllers.linear import HOLD, LinearController, LinearSystem, in_z
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace


def controller_from(lti: Any, discretisation: str | None = None) -> LinearController:
    """
    Return G_c, from slip error in rpm to torque in N m, as a controller.

    `lti` is a system that `linear_system` accepts. A continuous one is discretised at 10 ms by
    'hold', the default, or 'bilinear'. Raise ParameterError for a system that cannot run.
    """
    given = linear_system(lti)
    if given is None:
        raise ParameterError(
            f'{_name(lti)} is no linear system: give a TransferFunction, ZerosPolesGain or '
            'StateSpace of scipy.signal or python-control',
            key=_name(lti),
        )
    if discretisation and isinstance(given, StateSpace) and given.period_s:
        raise ParameterError(
            f'{_name(lti)}: it is sampled: drop discretisation={discretisation}',
            key='discretisation',
        )
    return LinearController(given, discretisation or HOLD)


def linear_system(lti: Any) -> LinearSystem | None:
    """
    Return a system in our form, continuous or sampled at 10 ms; None for any other object.

    It is a TransferFunction, ZerosPolesGain or StateSpace of scipy.signal, a TransferFunction or
    StateSpace of python-control, or in our form already. Raise ParameterError for one that is
    improper, has more than one input or output, or another period.
    """
    if isinstance(lti, (StateSpace, FactoredTransferFunction)):
        return lti
    # By what it holds, not by type: importing python-control takes a second.
    if type(lti).__module__.partition('.')[0] not in ('scipy', 'control'):
        return None
    form = _form(lti)
    if form is None:
        return None
    if isinstance(form, FactoredTransferFunction):
        form.to_state_space()
    if not lti.dt:
        return form
    if lti.dt is True:
        raise ParameterError(
            f'{_name(lti)}: dt is True, it does not say its period: give dt={PERIOD_S:g}', key='dt'
        )
    if abs(lti.dt - PERIOD_S) > 1e-9 * PERIOD_S:
        raise ParameterError(
            f'{_name(lti)}: dt is {lti.dt}, the loop has a period of {PERIOD_S:g} s: sample it at '
            'that, or give it continuous',
            key='dt',
        )
    return in_z(form)


def _form(lti: Any) -> LinearSystem | None:
    """Return the system without its period."""
    if all(hasattr(lti, name) for name in 'ABCD'):
        return StateSpace(lti.A, lti.B, lti.C, lti.D)
    if all(hasattr(lti, name) for name in ('zeros', 'poles', 'gain')):
        return FactoredTransferFunction.from_roots(float(lti.gain), lti.zeros, lti.poles)
    if all(hasattr(lti, name) for name in ('num', 'den', 'dt')):
        return FactoredTransferFunction.from_polynomials(
            _coefficients(lti, lti.num), _coefficients(lti, lti.den)
        )
    return None


def _coefficients(lti: Any, side: Any) -> np.ndarray:
    """Return one polynomial; python-control has a list of them for each output."""
    try:
        table = np.asarray(side, dtype=float)
    except ValueError:  # polynomials of different lengths
        table = np.zeros((2, 2))
    if table.size != table.shape[-1]:
        raise ParameterError(f'{_name(lti)}: give one input and one output', key='output')
    return table.ravel()


def _name(lti: Any) -> str:
    return f'{type(lti).__module__}.{type(lti).__name__}'
