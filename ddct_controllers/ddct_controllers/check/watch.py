# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Detect side effects of a controller: output, clock reads, random numbers, gains read."""

import io
import os
import random
import sys
import time
import uuid
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from types import ModuleType
from typing import Any

import numpy as np

CLOCKS = ('time', 'monotonic', 'perf_counter')
"""Names of clock functions of the module `time`; each has a twin in ns."""
SOURCES: tuple[tuple[ModuleType, tuple[str, ...]], ...] = (
    (time, (*CLOCKS, *(f'{name}_ns' for name in CLOCKS))),
    (random, ('random', 'uniform', 'gauss', 'normalvariate', 'randint', 'choice')),
    (np.random, ('default_rng', 'normal', 'rand', 'randint', 'randn', 'random', 'uniform')),
    (os, ('urandom',)),
    (uuid, ('uuid4',)),
)
LEAP_S = 1_000_003
"""Advance of the watched clocks in s, so large that one read in whole days differs too."""


def place_of_caller(depth: int) -> str:
    """Return `FILE line N` of the caller of the function `depth` calls above this one."""
    frame = sys._getframe(depth + 1)
    return f'{frame.f_code.co_filename} line {frame.f_lineno}'


class OutputMonitor(io.TextIOBase):
    """Stand-in for standard output that keeps the text and the place of the first write."""

    def __init__(self) -> None:
        """Start with no text."""
        self.text = self.place = ''

    def write(self, text: str) -> int:
        """Append the text; return its length."""
        self.place = self.place or place_of_caller(1)
        self.text += text
        return len(text)


class RecordedGains(dict[str, object]):
    """Gains of a context, with a record of the names that are read, and where."""

    def __init__(self, gains: Mapping[str, object]) -> None:
        """Copy the gains."""
        super().__init__(gains)
        self.places: dict[str, str] = {}

    def __getitem__(self, name: str) -> object:
        """Return a gain and record the access."""
        self._record(name)
        return super().__getitem__(name)

    def get(self, name: str, default: object = None) -> object:
        """Return a gain or the default, and record the access."""
        self._record(name)
        return super().get(name, default)

    def _record(self, name: str) -> None:
        self.places.setdefault(name, place_of_caller(2))


@contextmanager
def watched(package: str) -> Iterator[dict[str, str]]:
    """Advance the clocks, and yield by source, such as `time.time`, its first caller's place."""
    called: dict[str, str] = {}
    undo: list[tuple[ModuleType, str, Any]] = []
    own = [m for name, m in list(sys.modules.items()) if name.partition('.')[0] == package]
    for module, names in SOURCES:
        for name in names:
            original = getattr(module, name)
            stand_in = _recording(f'{module.__name__}.{name}', original, called)
            # `from time import time` has bound the original in a module of the controller.
            bound = [(each, key) for each in own for key, v in vars(each).items() if v is original]
            for each, key in [(module, name), *bound]:
                undo.append((each, key, original))
                setattr(each, key, stand_in)
    try:
        yield called
    finally:
        for each, key, original in undo:
            setattr(each, key, original)


def _recording(
    what: str, original: Callable[..., Any], called: dict[str, str]
) -> Callable[..., Any]:
    leap: Any = 0
    if what.startswith('time.'):
        leap = LEAP_S * (10**9 if what.endswith('_ns') else 1)

    def stand_in(*args: Any, **kwargs: Any) -> Any:
        called.setdefault(what, place_of_caller(1))
        answer = original(*args, **kwargs)
        return answer + leap if leap else answer

    return stand_in
