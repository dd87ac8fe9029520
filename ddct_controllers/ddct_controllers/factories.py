# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers of third parties: construction from a class or factory, and its declarations."""

from collections.abc import Callable, Mapping
from numbers import Real
from typing import Any

from ddct_controllers.interface import Controller, ControllerContext, ControllerSpec
from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError
from ddct_plant.base.options import Option


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
