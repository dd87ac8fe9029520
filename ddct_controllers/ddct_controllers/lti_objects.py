"""Controllers out of linear systems of other libraries: scipy.signal and python-control."""

from typing import Any

import numpy as np

from ddct_controllers.linear import Given, LinearController, in_z
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace


def controller_from(lti: Any, discretisation: str | None = None) -> LinearController:
    """
    Return G_c, from slip error in rpm to torque in N m, as a controller.

    `lti` is a TransferFunction, ZerosPolesGain or StateSpace of scipy.signal, or a
    TransferFunction or StateSpace of python-control. A continuous one is discretised at 10 ms by
    'hold', the default, or 'bilinear'; a sampled one must have `dt` 0.01. Neither library is
    imported here. Raise ParameterError for what cannot run.
    """
    period_s = getattr(lti, 'dt', None)
    form = _form(lti)
    if not period_s:
        return LinearController(form, discretisation or 'hold')
    if period_s is True or abs(period_s - PERIOD_S) > 1e-9 * PERIOD_S:
        raise ParameterError(
            f'{_name(lti)}: dt is {period_s}, the loop runs at {PERIOD_S:g} s: sample it at that, '
            'or give it continuous'
        )
    if discretisation:
        raise ParameterError(f'{_name(lti)}: it is sampled: drop discretisation={discretisation}')
    return LinearController(in_z(form))


def _form(lti: Any) -> Given:
    # By what they hold, not by type: importing python-control takes a second.
    if all(hasattr(lti, name) for name in 'ABCD'):
        return StateSpace(lti.A, lti.B, lti.C, lti.D)
    if all(hasattr(lti, name) for name in ('zeros', 'poles', 'gain')):
        return FactoredTransferFunction.from_roots(float(lti.gain), lti.zeros, lti.poles)
    if all(hasattr(lti, name) for name in ('num', 'den')):
        return FactoredTransferFunction.from_polynomials(
            _coefficients(lti, lti.num), _coefficients(lti, lti.den)
        )
    raise ParameterError(
        f'{_name(lti)} is no linear system: give a TransferFunction, ZerosPolesGain or StateSpace '
        'of scipy.signal or python-control'
    )


def _coefficients(lti: Any, side: Any) -> np.ndarray:
    """Return one polynomial; python-control has a list of them for each output."""
    try:
        table = np.asarray(side, dtype=float)
    except ValueError:  # polynomials of different lengths
        table = np.zeros((2, 2))
    if table.size != table.shape[-1]:
        raise ParameterError(f'{_name(lti)}: give one input and one output')
    return table.ravel()


def _name(lti: Any) -> str:
    return f'{type(lti).__module__}.{type(lti).__name__}'
