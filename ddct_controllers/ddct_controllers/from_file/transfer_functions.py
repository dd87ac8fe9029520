# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Linear controllers in a file: a transfer function in one of four forms, in s or in z."""

import cmath
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any

import numpy as np

from ddct_controllers.from_file.controller_file import ControllerFile, mapping, option_name
from ddct_controllers.interface import Controller, ControllerContext, ControllerSpec
from ddct_controllers.linear import (
    BILINEAR,
    HOLD,
    LinearController,
    LinearSystem,
    in_z,
    sampled,
)
from ddct_plant.base.errors import ParameterError, require_choice, require_number
from ddct_plant.base.options import Option
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.files.input_file import line_of
from ddct_plant.linear.cascade import Factor
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace

FACTORED = 'transfer_function'
UNITS = {'input': 'rpm', 'output': 'N m'}
"""Required units of the slip error and the clutch torque; no others are accepted."""
_REQUIRED, _OPTIONAL = ('units',), ('discretisation', 'sample_time_s')
BESIDE_LINEAR = (*_REQUIRED, *_OPTIONAL)
"""Keys of a file of a linear controller, beside its kind."""
FREQUENCY = {'frequency': 'rad/s'}
"""Unit of zeros and poles, which a file may state too."""


def linear_in(file: ControllerFile, kind: str) -> tuple[LinearSystem, str]:
    """
    Return the system in a file of `kind`, and the discretisation of a continuous one.

    Raise ParameterError for a system that cannot run, an improper G_c included.
    """
    content = file.keys(kind, _REQUIRED, _OPTIONAL)
    if content['units'] not in (UNITS, {**UNITS, **FREQUENCY}):
        raise ParameterError(
            f'units are {content["units"]!r}: convert the controller to {UNITS}', key='units'
        )
    discretisation = content.get('discretisation', HOLD)
    require_choice('discretisation', discretisation, (HOLD, BILINEAR))
    _require_period(content)
    try:
        given = _system(kind, content[kind], in_z_already='sample_time_s' in content)
        sampled(given, discretisation)
    except ParameterError as error:
        # The error of one coefficient has a line of its own, that of the whole system has none.
        if line_of(f'{error.key} {error}', file.lines):
            raise
        raise ParameterError(f'{kind}: {error}', key=kind) from error
    return given, discretisation


def _system(kind: str, form: Any, *, in_z_already: bool) -> LinearSystem:
    """Return the system of a form; raise ParameterError that names the wrong number."""
    given = FORMS[kind](kind, form)
    return in_z(given) if in_z_already else given


def _require_period(content: Mapping[str, Any]) -> None:
    if 'sample_time_s' not in content:
        return
    period_s = require_number('sample_time_s', content['sample_time_s'], unit='s')
    if period_s != PERIOD_S:
        raise ParameterError(
            f'sample_time_s is {period_s:g} s, the loop runs at {PERIOD_S:g} s: sample the '
            'controller at that, or give it continuous, without this key',
            key='sample_time_s',
        )
    if 'discretisation' in content:
        raise ParameterError(
            'discretisation is for a continuous controller, and sample_time_s says that this '
            'one is sampled: drop one of them',
            key='discretisation',
        )


def _linear_spec(kind: str, file: ControllerFile) -> ControllerSpec[Controller]:
    """Return the controller in a file; every real number of its form is an option."""
    given, discretisation = linear_in(file, kind)
    form, in_z_already = file.content[kind], 'sample_time_s' in file.content
    places = {option_name(path): path for path, _ in _numbers('', form)}
    options = {
        option_name(path): Option(float(value), f'{kind}{path} of the file')
        for path, value in _numbers('', form)
    }

    def make(context: ControllerContext) -> Controller:
        changed = {
            places[name]: value
            for name, value in context.gains.items()
            if value != options[name].default
        }
        if not changed:
            return LinearController(given, discretisation)
        with file.located():
            system = _system(kind, _with_numbers('', form, changed), in_z_already=in_z_already)
            return LinearController(system, discretisation)

    return ControllerSpec(file.name, make, options)


def _numbers(path: str, form: Any) -> Iterator[tuple[str, float]]:
    """Yield the numbers of a form by their paths in it, such as `.num[1]`."""
    if isinstance(form, Mapping):
        for key, value in form.items():
            yield from _numbers(f'{path}.{key}', value)
    elif isinstance(form, list):
        for place, value in enumerate(form):
            yield from _numbers(f'{path}[{place}]', value)
    elif isinstance(form, (int, float)) and not isinstance(form, bool):
        yield path, form


def _with_numbers(path: str, form: Any, changed: Mapping[str, float]) -> Any:
    """Return a form with the numbers at some paths replaced."""
    if isinstance(form, Mapping):
        return {key: _with_numbers(f'{path}.{key}', form[key], changed) for key in form}
    if isinstance(form, list):
        return [
            _with_numbers(f'{path}[{place}]', each, changed) for place, each in enumerate(form)
        ]
    return changed.get(path, form)


def _ratio(
    make: Callable[..., FactoredTransferFunction],
    sides: tuple[str, str],
    read: Callable[[str, Any], Any],
    example: str,
    path: str,
    content: Any,
) -> FactoredTransferFunction:
    """Read a gain and both sides of a ratio, lists of what `read` takes, and `make` G_c of it."""
    parts = mapping(path, content, (*sides, 'gain'))
    above, below = (
        tuple(read(*item) for item in _items(f'{path}.{side}', parts[side], example))
        for side in sides
    )
    return make(require_number(f'{path}.gain', parts['gain']), above, below)


def _factor(path: str, content: Any) -> Factor:
    """Read a number a as (s + a), a pair [b, c] as (s^2 + b s + c)."""
    if not isinstance(content, list):
        return require_number(f'{path}: a coefficient', content)
    if len(content) != 2:
        raise ParameterError(
            f'{path}: {content} is no factor: write a for (s + a), [b, c] for (s^2 + b s + c)',
            key=path,
        )
    b, c = (require_number(f'{path}: a coefficient', value) for value in content)
    return b, c


def _polynomial(path: str, content: Any) -> FactoredTransferFunction:
    """Read coefficients with the highest power first, as in scipy.signal and MATLAB."""
    parts = mapping(path, content, ('num', 'den'))
    num, den = (
        [require_number(*item) for item in _items(f'{path}.{key}', parts[key], '[1.0, 5.3]')]
        for key in ('num', 'den')
    )
    return FactoredTransferFunction.from_polynomials(num, den)


def _root(path: str, content: Any) -> complex:
    if not isinstance(content, str):
        return complex(require_number(path, content))
    try:
        root = complex(content.replace(' ', '').replace('i', 'j'))
    except ValueError as error:
        raise ParameterError(
            f'{path} is {content!r}: give a number such as -0.8 or -2.7+18.2j', key=path
        ) from error
    if not cmath.isfinite(root):
        raise ParameterError(f'{path} is {root}: give a finite number', key=path)
    return root


def _state_space(path: str, content: Any) -> StateSpace:
    """Read `a` row by row; in `b`, `c` and `d` brackets around single numbers may be missing."""
    parts = mapping(path, content, ('a', 'b', 'c', 'd'))
    rows = [row for _, row in _items(f'{path}.a', parts['a'], '[[-1.0, 0.0], [2.0, 3.0]]')]
    states = len(rows)
    if any(not isinstance(row, list) or len(row) != states for row in rows):
        raise ParameterError(
            f'{path}.a: give as many rows as columns, each row a list', key=f'{path}.a'
        )
    sizes = {'a': (states, states), 'b': (states, 1), 'c': (1, states), 'd': (1, 1)}
    a, b, c, d = (_matrix(f'{path}.{key}', parts[key], *size) for key, size in sizes.items())
    return StateSpace(a, b, c, d)


def _matrix(path: str, content: Any, rows: int, columns: int) -> np.ndarray:
    entries = _entries(path, content)
    if len(entries) != rows * columns:
        raise ParameterError(
            f'{path} has {len(entries)} numbers: with the states of a, one input and one output '
            f'it must be {rows} x {columns}',
            key=path,
        )
    return np.reshape(entries, (rows, columns))


def _entries(path: str, content: Any) -> list[float]:
    if not isinstance(content, list):
        return [require_number(path, content)]
    return [entry for i, item in enumerate(content) for entry in _entries(f'{path}[{i}]', item)]


def _items(path: str, content: Any, example: str) -> list[tuple[str, Any]]:
    """Return the items of a list, each behind its path."""
    if not isinstance(content, list):
        raise ParameterError(f'{path} is {content!r}: give a list, such as {example}', key=path)
    return [(f'{path}[{i}]', item) for i, item in enumerate(content)]


FORMS: Mapping[str, Callable[[str, Any], LinearSystem]] = {
    FACTORED: partial(
        _ratio,
        FactoredTransferFunction,
        ('numerator', 'denominator'),
        _factor,
        '[0.0, [5.3, 339.4]]',
    ),
    'polynomial': _polynomial,
    'zeros_poles_gain': partial(
        _ratio,
        FactoredTransferFunction.from_roots,
        ('zeros', 'poles'),
        _root,
        '[-0.8, -2.7+18.2j]',
    ),
    'state_space': _state_space,
}
"""Readers by the key in the file; each takes the key and its value."""
LINEAR = {kind: partial(_linear_spec, kind) for kind in FORMS}
"""Loaders of the linear kinds by their key."""
