"""Numbers and remarks as C99 text."""

import math
import re
from collections.abc import Mapping
from importlib.resources import files
from textwrap import TextWrapper

import numpy as np

_LINES = TextWrapper(
    99,
    initial_indent='    ',
    subsequent_indent='    ',
    break_long_words=False,
    break_on_hyphens=False,
)


def c_part(name: str) -> str:
    """Return the hand-written C in the file `name`."""
    return (files('ddct_controllers.mpc.export') / 'c' / name).read_text(encoding='utf-8')


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
    return f'static const double {name}{sizes} = {_braced(array)};'


def _braced(array: np.ndarray) -> str:
    if array.ndim > 1:
        return '{\n' + ',\n'.join(_braced(row) for row in array) + '\n}'
    numbers = ' '.join(f'{_number(float(value))},' for value in array)
    return '{\n' + _LINES.fill(numbers).removesuffix(',') + '\n}'


def _value(value: int | float) -> str:
    """Return what a macro stands for; a sign needs brackets, as an operator may precede it."""
    text = str(value) if isinstance(value, int) else _number(value)
    return f'({text})' if text.startswith('-') else text


def _number(value: float) -> str:
    """Return the shortest text that reads back as the same double."""
    if math.isinf(value):
        return 'HUGE_VAL' if value > 0.0 else '-HUGE_VAL'
    return repr(value)
