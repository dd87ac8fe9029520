# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Controllers and handovers of others: their entry points, and controllers from their classes.

A plug-in comes by an entry point, in a file of Python, or, for controllers, in a YAML file.
"""

import importlib.metadata
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from importlib.metadata import EntryPoint, EntryPoints
from numbers import Real
from pathlib import Path
from typing import Any

from ddct_controllers.interface import Controller, ControllerContext, ControllerSpec
from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError
from ddct_plant.base.options import Option


@dataclass(frozen=True)
class Plugins:
    """What the installed packages add to one group of entry points, `name = module:factory`."""

    kind: str
    """What they are, as 'controller', for error messages."""
    group: str

    def points(self) -> EntryPoints:
        """Return the entry points of the group."""
        return _installed(tuple((folder, _changed_ns(folder)) for folder in sys.path)).select(
            group=self.group
        )

    def names(self) -> list[str]:
        """Return the names, sorted."""
        return sorted(self.points().names)

    def point(self, name: str) -> EntryPoint | None:
        """Return the first entry point of a name, None where there is none."""
        return next(iter(self.points().select(name=name)), None)

    def load(self, point: EntryPoint) -> Callable[..., Any]:
        """Return what an entry point names; raise DdctError where that fails."""
        try:
            factory: Callable[..., Any] = point.load()
        except FOREIGN_FAILURES as error:
            raise DdctError(
                f'the entry point {point.value} cannot be loaded ({type(error).__name__}: '
                f'{error}): mend or uninstall the package that adds it',
                key=point.value,
                place=f'{self.kind} {point.name!r}',
            ) from error
        return factory


CONTROLLERS = Plugins('controller', 'ddct.controllers')
"""Controllers; the factory takes a ControllerContext."""
HANDOVERS = Plugins('handover', 'ddct.handovers')
"""Handovers of a gear shift; the class takes a KnownSettings."""


def factory_spec(
    name: str, factory: Callable[[ControllerContext], Any], source: str
) -> ControllerSpec[Controller]:
    """
    Return the specification of a third party's controller from its class or factory.

    `source` is the place of the factory. Raise DdctError for a declaration that is not allowed.
    """

    def make(context: ControllerContext) -> Controller:
        try:
            return _plain(name, source, factory(context))
        except DdctError:
            raise
        except FOREIGN_FAILURES as error:
            raise DdctError(
                f'{source} failed ({type(error).__name__}: {error}): mend its code',
                key=source,
                place=f'controller {name!r}',
            ) from error

    options = getattr(factory, 'options', None)
    _require(
        options is None or _is_mapping(options, Option),
        name,
        f'options are {options!r}',
        'a mapping of names to ddct_plant.base.options.Option, or None',
    )
    return ControllerSpec(name, make, options)


def _plain(name: str, source: str, controller: object) -> Controller:
    """Return the controller; raise DdctError unless its declarations have the right types."""
    if not isinstance(controller, Controller):
        raise DdctError(
            f'{source} returned {type(controller).__name__}, not a '
            'ddct_controllers.interface.Controller',
            key=source,
            place=f'controller {name!r}',
        )
    preview = controller.preview_steps
    _require(
        type(preview) is int and preview >= 0,
        name,
        f'preview_steps is {preview!r}',
        'a whole number of steps',
    )
    two_input = controller.commands_engine
    _require(type(two_input) is bool, name, f'commands_engine is {two_input!r}', 'True or False')
    gains = controller.gains()
    _require(_is_mapping(gains, Real), name, f'gains() is {gains!r}', 'numbers by name')
    info = controller.info(name)
    _require(_is_mapping(info, str), name, f'info() is {info!r}', 'text by name')
    return controller


def _require(usable: bool, name: str, found: str, usable_form: str) -> None:
    """Raise DdctError with the value found in the controller `name`, unless it is usable."""
    if not usable:
        raise DdctError(
            f'its {found}: give {usable_form}', key=found.split()[0], place=f'controller {name!r}'
        )


def _is_mapping(content: object, kind: type) -> bool:
    """Return whether `content` maps text to values of a kind."""
    return isinstance(content, Mapping) and all(
        isinstance(key, str) and isinstance(value, kind) for key, value in content.items()
    )


@lru_cache(maxsize=1)
def _installed(_folders: tuple[tuple[str, int], ...]) -> EntryPoints:
    """Read the metadata of all packages, which takes as long as a short run."""
    found: EntryPoints = importlib.metadata.entry_points()  # type: ignore[assignment]  # of 3.11
    return found


def _changed_ns(folder: str) -> int:
    """Return when a package was last added to a folder or removed from it, 0 without one."""
    try:
        return Path(folder).stat().st_mtime_ns
    except OSError:
        return 0
