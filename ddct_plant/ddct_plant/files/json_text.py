"""The one way in which JSON from files and bags is read."""

import json
import re
from typing import Any, NoReturn

from ddct_plant.base.errors import ParameterError

_SURROGATE = re.compile(r'\\u[dD][89a-fA-F]')


def parse_json(text: str) -> Any:
    """
    Return the values that JSON text holds; raise ParameterError that says what is wrong with it.

    Refused beyond the grammar: keys given twice, NaN and infinity, halves of surrogate pairs,
    integers and nesting that Python cannot take.
    """
    try:
        value = json.loads(text, object_pairs_hook=_object, parse_constant=_refuse_constant)
        if _SURROGATE.search(text):
            json.dumps(value, ensure_ascii=False).encode('utf-8')
    except RecursionError as error:
        raise ParameterError('not valid JSON: nested too deeply') from error
    except ParameterError:
        raise
    except ValueError as error:
        raise ParameterError(f'not valid JSON: {error}') from error
    return value


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    value = dict(pairs)
    if len(value) != len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise ParameterError(f'not valid JSON: the key {twice!r} is given twice')
    return value


def _refuse_constant(constant: str) -> NoReturn:
    raise ParameterError(f'not valid JSON: {constant} is no number')
