# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Relative deviations of two values, of two texts, and of a signal at each step."""

import math
import re
from typing import Any

import numpy as np

_NUMBER = re.compile(r'[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?')


def deviation_of(recorded: Any, repeated: Any) -> float | None:
    """Return the relative difference of two values, None for equal ones, infinity without one."""
    if recorded == repeated and isinstance(recorded, bool) == isinstance(repeated, bool):
        return None
    if isinstance(recorded, str) and isinstance(repeated, str):
        return _text_deviation(recorded, repeated)
    if _is_number(recorded) and _is_number(repeated):
        try:
            both_undefined = math.isnan(recorded) and math.isnan(repeated)
            return None if both_undefined else _relative(recorded, repeated)
        except OverflowError:  # a whole number beyond the largest float
            return math.inf
    return math.inf


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _relative(recorded: float, repeated: float) -> float:
    difference = abs(recorded - repeated) / max(1.0, abs(recorded), abs(repeated))
    return difference if math.isfinite(difference) else math.inf


def _text_deviation(recorded: str, repeated: str) -> float:
    """Return the largest difference of the numbers in two texts of the same words."""
    if _NUMBER.split(recorded) != _NUMBER.split(repeated):
        return math.inf
    pairs = zip(_NUMBER.findall(recorded), _NUMBER.findall(repeated), strict=True)
    return max((_relative(float(ours), float(theirs)) for ours, theirs in pairs), default=math.inf)


def deviations_of(recorded: Any, repeated: Any) -> np.ndarray:
    """Return the relative difference at each step, (N+1,); -1 where all bits are equal."""
    if isinstance(recorded, np.ndarray):
        return _array_deviations(recorded, repeated)
    pairs = zip(recorded, repeated, strict=True)
    return np.array([-1.0 if a == b else _text_deviation(repr(a), repr(b)) for a, b in pairs])


def _array_deviations(recorded: np.ndarray, repeated: np.ndarray) -> np.ndarray:
    """Return the largest relative difference at each step, (N+1,); -1 where all bits are equal."""
    ours, theirs = (np.ascontiguousarray(each, dtype=float) for each in (recorded, repeated))
    unequal = ours.view(np.uint64) != theirs.view(np.uint64)
    with np.errstate(all='ignore'):
        scale = np.maximum(1.0, np.nanmax(np.abs(ours), axis=0, initial=0.0))
        relative = np.abs(ours - theirs) / scale
    relative = np.where(np.isfinite(relative), relative, np.inf)
    found = np.where(unequal, relative, -1.0)
    return found.reshape(len(found), -1).max(axis=1, initial=-1.0)
