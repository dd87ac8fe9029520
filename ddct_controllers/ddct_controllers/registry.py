# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers by name: our own, those of other packages, and those in a file."""

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any, TypeVar

from ddct_controllers.from_file.controller_file import YAML_SUFFIXES, is_controller_file
from ddct_controllers.from_file.fmu.unpacked import remove_left_folders
from ddct_controllers.from_file.kinds import load_spec
from ddct_controllers.interface import (
    CompiledCode,
    Controller,
    ControllerContext,
    ControllerSpec,
)
from ddct_controllers.least_jerk.controller import SPEC as LEAST_JERK
from ddct_controllers.linear import PI, LinearController
from ddct_controllers.mpc.variants import PREDICTIVE
from ddct_controllers.plugins import CONTROLLERS, factory_spec
from ddct_controllers.printed import PRINTED_CONTROLLERS, printed_spec
from ddct_controllers.state_of_art.controllers import STATE_OF_ART
from ddct_controllers.synthesised import SYNTHESISED, synthesised_design
from ddct_plant.base.errors import DdctError, ParameterError, choices_hint, require_name
from ddct_plant.program.own_process import ProcessEndedError, in_own_process
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import KnownSettings

Chosen = str | ControllerSpec[Controller]
"""Choice of a controller: its name or file, or the specification of one without either."""
Result = TypeVar('Result')


def _synthesised(name: str, context: ControllerContext) -> Controller:
    scenario = context.settings.scenario
    design = synthesised_design(name, scenario.driveline, scenario.actuator)
    return LinearController(design.sampled)


_OWN: Mapping[str, ControllerSpec[Controller]] = {
    'pi': PI,
    **{name: printed_spec(name, g_c) for name, g_c in PRINTED_CONTROLLERS.items()},
    **{name: ControllerSpec(name, partial(_synthesised, name), {}) for name in SYNTHESISED},
    **PREDICTIVE,
    **STATE_OF_ART,
    LEAST_JERK.name: LEAST_JERK,
}
"""Specifications of the controllers in this package, by name."""


def own_controller_names() -> list[str]:
    """Return the names of the controllers that come with this package."""
    return list(_OWN)


def controller_names() -> list[str]:
    """Return every name that `make_controller` accepts besides files, our own first."""
    own = own_controller_names()
    return own + [name for name in CONTROLLERS.names() if name not in own]


def require_known_controllers(scenario: Scenario, labels: Iterable[str]) -> None:
    """
    Raise ParameterError if a scenario has options for a controller that does not exist.

    Or if one of ours does not have them, though it may not run. Those of others are checked when
    their controller is requested.
    """
    if not scenario.controllers:
        return
    foreign = scenario.controllers.keys() - {*_OWN, *labels}
    unknown = sorted(foreign - {*controller_names()}) if foreign else []
    if unknown:
        raise ParameterError(
            f'controllers.{unknown[0]}: there is no such controller: choose from '
            f'{", ".join(controller_names())}',
            key=f'controllers.{unknown[0]}',
        )
    for name, given in scenario.controllers.items():
        if name in _OWN:
            _OWN[name].values(given)


def working_controllers(settings: KnownSettings, report: Callable[[str], None]) -> list[str]:
    """
    Return the names of `controller_names` whose controllers can be built for a run.

    `report` gets a line about each of a third party that cannot. A controller with options in the
    scenario counts as requested: it stays, and making it raises.
    """
    trusted = {*own_controller_names(), *settings.scenario.controllers}
    names = []
    for name in controller_names():
        try:
            if name not in trusted:
                make_controller(name, settings)
            names.append(name)
        except DdctError as error:
            report(f'{error}; left out')
    return names


def make_controller(
    chosen: Chosen, settings: KnownSettings, changes: Mapping[str, Any] | None = None
) -> Controller:
    """
    Build a controller for a run, from its known settings.

    `changes` go before the scenario's section `controllers.<name>`. Raise ParameterError for an
    unknown name or an option that the controller does not have, and DdctError when a file cannot
    be read or a third party's factory fails.
    """
    spec = controller_spec(chosen)
    given = {**settings.scenario.controllers.get(spec.name, {}), **(changes or {})}
    controller = spec(ControllerContext(settings, given))
    controller.registered_name = spec.name
    controller.digests = spec.digests
    controller.written_in = spec.written_in
    return controller


def controller_spec(chosen: Chosen) -> ControllerSpec[Controller]:
    """Return a controller's specification; raise the errors of `make_controller`."""
    if isinstance(chosen, ControllerSpec):
        return chosen
    if is_controller_file(chosen):
        spec = load_spec(chosen, controller_spec)
        if spec.name in controller_names():
            raise ParameterError(
                f'the name {spec.name!r} is taken by another controller; change it in the file',
                key='name',
                place=f'controller file {chosen}',
            )
        return spec
    return _OWN.get(chosen) or _third_party(chosen)


def separately(chosen: Chosen, work: Callable[[Chosen], Result]) -> Result:
    """
    Return `work(chosen)`, in a process of its own where the controller is compiled code.

    Each run of such code has one: its static variables start afresh, and ProcessEndedError with
    its place and the reason is raised when it crashes, ends its process or loops without end.
    Result and errors of `work` are pickled then.
    """
    code = compiled_code(chosen)
    if code is None:
        return work(chosen)
    try:
        # The specification, as a file may change meanwhile.
        return in_own_process(partial(work, controller_spec(chosen)))
    except ProcessEndedError as error:
        remove_left_folders()
        raise ProcessEndedError(
            f'{code.key}: {code.path}: {error}: mend it', key=code.key, place=code.place
        ) from error


def compiled_code(chosen: Chosen) -> CompiledCode | None:
    """Return the compiled code that a controller is; None for one in Python."""
    if isinstance(chosen, str) and not chosen.endswith(YAML_SUFFIXES):
        return None
    return controller_spec(chosen).compiled


def controller_label(chosen: Chosen) -> str:
    """Return the name of a controller in bags and tables; a file contains its name."""
    if isinstance(chosen, str) and not is_controller_file(chosen):
        return chosen
    return controller_spec(chosen).name


def controllers_of(text: str) -> list[str]:
    """
    Return the controllers in the value of --controllers that names some.

    Raise ParameterError for none, and for one that is given twice.
    """
    names = [name.strip() for name in text.split(',') if name.strip()]
    if not names:
        raise ParameterError('--controllers is empty: name at least one, or all')
    labels = [controller_label(name) for name in names]
    for label in labels:
        if labels.count(label) > 1:
            raise ParameterError(f'--controllers names {label} twice: name each once')
    return names


def _third_party(name: str) -> ControllerSpec[Controller]:
    if point := CONTROLLERS.point(name):
        require_name('controller name', name)  # it names the folder of the bag
        return factory_spec(name, CONTROLLERS.load(point), point.value)
    if '.' in name or '/' in name:
        raise ParameterError(
            f'{name} is no controller file: give a Python file or a YAML file; for an FMU or a '
            'library in C, a YAML file that names it (docs/controllers/files.md)',
            key=name,
        )
    raise ParameterError(
        f'unknown controller {name!r}: {choices_hint(name, controller_names())}, or give the '
        'path of a controller file, .py or .yaml',
        key=name,
    )
