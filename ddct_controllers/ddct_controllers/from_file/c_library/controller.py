# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller in a shared library, and the loader of `c_library`."""

import json
import re
import struct
from collections.abc import Mapping
from operator import attrgetter
from pathlib import Path
from types import MappingProxyType

from ddct_controllers.from_file.c_library import host
from ddct_controllers.from_file.controller_file import ControllerFile, mapping
from ddct_controllers.from_file.foreign.loaded import (
    CodeFailedError,
    CodeRefusedError,
    LoadedCode,
    loaded_code,
)
from ddct_controllers.interface import (
    UNSTATED,
    Command,
    Controller,
    ControllerContext,
    ControllerSpec,
    Measurement,
)
from ddct_plant.base.errors import DdctError, ParameterError, require_number
from ddct_plant.base.options import Option, Options

KIND = 'c_library'
_SCALARS = attrgetter(
    *('step', 'engine_speed', 'shaft_speed', 'wheel_speed', 'vehicle_speed'),
    *('engine_torque', 'load_torque', 'open_loop_torque'),
)
"""Scalars of a measurement, in the order of the struct ddct_measurement."""
_IDENTIFIER = re.compile(r'[A-Za-z_]\w*', re.ASCII)
_CALLS = {host.RESET: 'reset', host.UPDATE: 'update', host.HOLD: 'hold'}


def c_library_spec(file: ControllerFile) -> ControllerSpec[Controller]:
    """
    Return the controller behind `c_library: {file: libmine.so}`, a path from the YAML file.

    Its options are the global variables in `parameters`.
    """
    keys = mapping(KIND, file.keys(KIND)[KIND], ('file',), optional=('parameters',))
    path = file.named_file(KIND, keys['file'], 'a shared library, compiled first')
    options = _options(keys.get('parameters') or {})

    libraries: list[LoadedCode] = []

    def make(context: ControllerContext) -> Controller:
        with file.located():
            controller = CLibraryController(path, context.gains)
        libraries[:] = [controller.library]  # it stays loaded between the runs of a campaign
        return controller

    return ControllerSpec(file.name, make, options, UNSTATED)


def _options(given: object) -> Options:
    """Return an option for each global variable that the file gives a value."""
    options = {}
    for name, value in mapping(f'{KIND}.parameters', given).items():
        where = f'{KIND}.parameters.{name}'
        if not _IDENTIFIER.fullmatch(str(name)):
            raise ParameterError(f'{where}: give the name of a variable of C', key=where)
        options[str(name)] = Option(require_number(where, value), 'variable of the library')
    return options


class CLibraryController(Controller):
    """Controller whose library runs in a process of its own, called at every step."""

    method_names = MappingProxyType({name: f'ddct_controller_{name}' for name in _CALLS.values()})

    def __init__(self, path: Path, parameters: Mapping[str, float] = MappingProxyType({})) -> None:
        """
        Start its process, with the values of global variables by name.

        Raise ParameterError when the library cannot be used, or lacks a variable.
        """
        self._where = f'{KIND}.file: {path}'
        try:
            self.library = loaded_code(Path(host.__file__), path)
            self._process = self.library.start()
        except CodeRefusedError as error:
            raise ParameterError(f'{self._where}: {error}') from error
        except CodeFailedError as error:
            raise self._failed(error, 'it was loaded') from error
        self.preview_steps: int = self.library.about['preview_steps']
        self.commands_engine: bool = self.library.about['commands_engine']
        self._layout = struct.Struct(f'q7d{2 * (self.preview_steps + 1)}d')
        if parameters:
            self._set(parameters)
        self.reset()

    def reset(self) -> None:
        """Call ddct_controller_reset."""
        self._call(host.RESET)

    def hold(self, measurement: Measurement) -> None:
        """Call ddct_controller_hold, or reset where there is none."""
        self._call(host.HOLD, measurement)

    def update(self, measurement: Measurement) -> Command:
        """Call ddct_controller_update; raise DdctError when it fails or returns an error."""
        clutch, engine, status = self._call(host.UPDATE, measurement)
        pairs = (('c_status', str(status)),)
        return Command(clutch, pairs, engine if self.commands_engine else None)

    def _set(self, parameters: Mapping[str, float]) -> None:
        request = bytes([host.SET]) + json.dumps(dict(parameters)).encode()
        _, _, status = self._answer(request, 'its parameters were set')
        if status:
            self._process.end()
            name = list(parameters)[-status - 1]
            raise ParameterError(
                f'{KIND}.parameters.{name}: the library has no such variable: declare it outside '
                f'of all functions as `double {name}`, neither static nor const',
                key=f'{KIND}.parameters.{name}',
            )

    def _answer(self, request: bytes, when: str) -> tuple[float, float, int]:
        try:
            clutch, engine, status = host.ANSWER.unpack(self._process.call(request))
        except CodeFailedError as error:
            raise self._failed(error, when) from error
        return clutch, engine, status

    def _call(self, call: int, measurement: Measurement | None = None) -> tuple[float, float, int]:
        request, when = bytes([call]), f'{_CALLS[call]} was called'
        if measurement is not None:
            when += f' at step {measurement.step}'
            references = (*measurement.slip_reference, *measurement.slip_reference_rate)
            request += self._layout.pack(*_SCALARS(measurement), *references)
        clutch, engine, status = self._answer(request, when)
        if status < 0:
            self._process.end()
            raise DdctError(f'{self._where}: it returned {status} when {when}: mend the C')
        return clutch, engine, status

    def _failed(self, error: CodeFailedError, when: str) -> DdctError:
        return DdctError(f'{error} when {when}: mend the C', place=self._where)
