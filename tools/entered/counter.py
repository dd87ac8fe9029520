# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Classes and functions of the project that a call enters, counted by `sys.setprofile`."""

import inspect
import sys
from collections.abc import Callable
from types import CodeType, FrameType
from typing import Any, NamedTuple

PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
EQUATIONS = ('ddct_plant.models', 'ddct_plant.friction', 'ddct_plant.shift')
"""Rooms with the equations of the plant."""
STEP = 'step'
"""Method of a driveline that integrates a period."""
_GENERATED = '<string>'
"""File of the methods that dataclasses and named tuples are given."""


class Noun(NamedTuple):
    """What a reader has to learn: a class, for any of its methods, or a function."""

    module: str
    name: str

    @property
    def is_class(self) -> bool:
        """Whether it is a class."""
        defined: Any = getattr(sys.modules[self.module], self.name, None)
        return isinstance(defined, type)

    @property
    def of_equations(self) -> bool:
        """Whether its room is one of `EQUATIONS`."""
        return '.'.join(self.module.split('.')[:2]) in EQUATIONS


class Entered:
    """Nouns that calls enter in this thread; what is done on import does not count."""

    def __init__(self) -> None:
        """Start with none."""
        self.nouns: set[Noun] = set()
        """All that are entered."""
        self.way: set[Noun] = set()
        """
        Those on the way to the equations in the periods of a run.

        That is on the stack when a function of the equations is entered, this one included,
        between the first step of the driveline and the last.
        """
        self._since_step: set[Noun] | None = None
        self._known: dict[CodeType, Noun | None] = {}

    def call(self, function: Callable[[], object]) -> None:
        """Call a function and count what it enters."""
        sys.setprofile(self._profile)
        try:
            function()
        finally:
            sys.setprofile(None)

    def _profile(self, frame: FrameType, event: str, _: object) -> None:
        if event != 'call' or not (noun := self._noun_of(frame)):
            return
        if noun not in self.nouns and not _imported_by(frame):
            self.nouns.add(noun)
        if not noun.of_equations:
            return
        if frame.f_code.co_name == STEP:
            self.way |= self._since_step or set()
            self._since_step = set()
        if self._since_step is not None:
            above: FrameType | None = frame
            while above:
                if found := self._noun_of(above):
                    self._since_step.add(found)
                above = above.f_back

    def _noun_of(self, frame: FrameType) -> Noun | None:
        code = frame.f_code
        if code not in self._known:
            self._known[code] = _noun(frame)
        return self._known[code]


def _imported_by(frame: FrameType | None) -> bool:
    """Return whether a module or a class of the packages that is being defined calls this."""
    while frame and not _defines(frame):
        frame = frame.f_back
    return frame is not None


def _defines(frame: FrameType) -> bool:
    return not frame.f_code.co_flags & inspect.CO_NEWLOCALS and _in_packages(_module(frame))


def _module(frame: FrameType) -> str:
    return str(frame.f_globals.get('__name__'))


def _in_packages(module: str) -> bool:
    return module.partition('.')[0] in PACKAGES


def _noun(frame: FrameType) -> Noun | None:
    """Return the noun of a frame; None for one of other packages, and for a definition."""
    code = frame.f_code
    if _defines(frame):
        return None
    module, name = _module(frame), code.co_qualname
    if code.co_filename == _GENERATED and code.co_argcount:
        first = frame.f_locals.get(code.co_varnames[0])
        owner = first if isinstance(first, type) else type(first)
        module, name = owner.__module__, owner.__qualname__
    return Noun(module, name.partition('.')[0]) if _in_packages(module) else None
