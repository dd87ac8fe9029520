# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Text of exported C: macros, constant arrays and comments."""

import math
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

_BRACES = str.maketrans('[]', '{}')


def macros(values: Mapping[str, int | float], prefix: str = '') -> str:
    """Return one `#define` per value."""
    return '\n'.join(f'#define {prefix}{name} {_value(value)}' for name, value in values.items())


def constants(arrays: Mapping[str, np.ndarray]) -> str:
    """Return each vector or matrix as a `static const double` array that reads back exactly."""
    return '\n\n'.join(_constant(name, array) for name, array in arrays.items())


def remark(lines: list[str]) -> str:
    """Return a comment; characters that could end it or start another are replaced."""
    plain = (re.sub(r'[^\w .,:;()=+|/^\'-]', '_', line, flags=re.ASCII) for line in lines)
    return '\n'.join(['/*', *(f' * {line}'.rstrip() for line in plain), ' */'])


def _constant(name: str, array: np.ndarray) -> str:
    sizes = ''.join(f'[{size}]' for size in array.shape)
    rows = np.array2string(
        np.asarray(array, dtype=float),
        max_line_width=99,
        separator=', ',
        threshold=array.size + 1,  # all of them
        formatter={'float_kind': _number},
    )
    return f'static const double {name}{sizes} =\n{rows.translate(_BRACES)};'


def _value(value: int | float) -> str:
    """Return a macro's value; a sign needs brackets, as an operator may precede it."""
    text = str(value) if isinstance(value, int) else _number(value)
    return f'({text})' if text.startswith('-') else text


def _number(value: float | np.floating[Any]) -> str:
    """Return the shortest text that reads back as the same double."""
    if math.isinf(value):
        return 'HUGE_VAL' if value > 0.0 else '-HUGE_VAL'
    return repr(float(value))
