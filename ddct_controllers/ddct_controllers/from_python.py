# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers out of Python objects: names, classes, factories, controllers, linear systems."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from ddct_controllers.interface import Controller, ControllerContext, ControllerSpec
from ddct_controllers.linear import HOLD, LinearSystem, linear_spec
from ddct_controllers.lti_objects import linear_system
from ddct_controllers.plugins import factory_spec
from ddct_controllers.registry import Chosen, controller_names
from ddct_plant.base.errors import ParameterError, require_name

_LINEAR = 'linear'
"""Name of a linear system without a name of its own."""


def chosen_from(controller: Any, name: str = '') -> Chosen:
    """
    Return a choice of controller in the form that `make_controller` accepts.

    `controller` is a name or file of the registry; a `Controller` class, or another factory that
    takes a `ControllerContext`; a `Controller`, which each run resets; or G_c, from slip error in
    rpm to torque in N m, as a system of scipy.signal or python-control, continuous (then held over
    10 ms) or with a period of 10 ms. `name` is the name in bags and tables of a controller that
    has none in the registry, by default the name of the class. Raise ParameterError for anything
    else, and for a name that is taken.
    """
    if isinstance(controller, (str, Path, ControllerSpec)):
        if name:
            raise ParameterError(
                f'name is {name!r}, but {controller!r} keeps the name it has', key='name'
            )
        return controller if isinstance(controller, ControllerSpec) else str(controller)
    if isinstance(controller, Controller):
        name = _free(name or type(controller).__name__)
        return replace(factory_spec(name, _same(controller), name), options={})
    if (model := _linear_system(controller, name or _LINEAR)) is not None:
        name = _free(name or _LINEAR)
        return replace(linear_spec(name, model, HOLD), written_in=f'the linear system {name!r}')
    if callable(controller):
        source = getattr(controller, '__name__', type(controller).__name__)
        return factory_spec(_free(name or source), controller, source)
    raise ParameterError(
        f'{controller!r} is no controller: give a name, a file, a Controller or its class',
        key=repr(controller),
    )


def _free(name: str) -> str:
    require_name('controller name', name)
    if name in controller_names():
        raise ParameterError(
            f'the name {name!r} is taken by another controller: give name=...', key=name
        )
    return name


def _same(controller: Controller) -> Any:
    def make(context: ControllerContext) -> Controller:
        controller.reset()
        return controller

    return make


def _linear_system(system: Any, name: str) -> LinearSystem | None:
    """Return a linear system in our form, None for any other object."""
    try:
        return linear_system(system)
    except ParameterError as error:
        raise error.at(f'controller {name!r}') from error
