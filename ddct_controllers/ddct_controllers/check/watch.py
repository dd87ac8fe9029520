"""See what a controller does besides answering: print, read a clock, draw, ask for gains."""

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
"""Clocks of the module time; each has a twin in ns."""
SOURCES: tuple[tuple[ModuleType, tuple[str, ...]], ...] = (
    (time, (*CLOCKS, *(f'{name}_ns' for name in CLOCKS))),
    (random, ('random', 'uniform', 'gauss', 'normalvariate', 'randint', 'choice')),
    (np.random, ('default_rng', 'normal', 'rand', 'randint', 'randn', 'random', 'uniform')),
    (os, ('urandom',)),
    (uuid, ('uuid4',)),
)
LEAP_S = 1_000_003
"""How far the watched clocks are ahead, so that one that is read in whole days differs too."""


def place_of_caller(depth: int) -> str:
    """Return `FILE line N` of who called the function `depth` calls above this one."""
    frame = sys._getframe(depth + 1)
    return f'{frame.f_code.co_filename} line {frame.f_lineno}'


class Printed(io.TextIOBase):
    """Takes the place of standard output and remembers who wrote there first."""

    def __init__(self) -> None:
        """Start with nothing written."""
        self.text = self.place = ''

    def write(self, text: str) -> int:
        """Take the text."""
        self.place = self.place or place_of_caller(1)
        self.text += text
        return len(text)


class AskedGains(dict[str, Any]):
    """The gains of a context, which remember the names that are asked for, and where."""

    def __init__(self, gains: Mapping[str, Any]) -> None:
        """Hold the gains."""
        super().__init__(gains)
        self.asked: dict[str, str] = {}

    def __getitem__(self, name: str) -> Any:
        """Return a gain."""
        self._note(name)
        return super().__getitem__(name)

    def get(self, name: str, default: Any = None) -> Any:
        """Return a gain or the default."""
        self._note(name)
        return super().get(name, default)

    def _note(self, name: str) -> None:
        self.asked.setdefault(name, place_of_caller(2))


@contextmanager
def watched(package: str) -> Iterator[dict[str, str]]:
    """Let clocks leap, and yield by source, such as `time.time`, where code first called it."""
    called: dict[str, str] = {}
    undo: list[tuple[ModuleType, str, Any]] = []
    own = [m for name, m in list(sys.modules.items()) if name.partition('.')[0] == package]
    for module, names in SOURCES:
        for name in names:
            original = getattr(module, name)
            stand_in = _noting(f'{module.__name__}.{name}', original, called)
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


def _noting(what: str, original: Callable[..., Any], called: dict[str, str]) -> Callable[..., Any]:
    leap: Any = 0
    if what.startswith('time.'):
        leap = LEAP_S * (10**9 if what.endswith('_ns') else 1)

    def stand_in(*args: Any, **kwargs: Any) -> Any:
        called.setdefault(what, place_of_caller(1))
        answer = original(*args, **kwargs)
        return answer + leap if leap else answer

    return stand_in
