# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller in a shared library, and the loader of `c_library`."""

import re
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from ddct_controllers.from_file.c_library.library import Library, LibraryError, interface
from ddct_controllers.from_file.controller_file import ControllerFile, mapping
from ddct_controllers.interface import (
    Command,
    Controller,
    ControllerContext,
    ControllerSpec,
    Measurement,
)
from ddct_plant.base.errors import DdctError, ParameterError, require_number
from ddct_plant.base.options import Option, Options
from ddct_plant.program.own_process import calling

KIND = 'c_library'
_IDENTIFIER = re.compile(r'[A-Za-z_]\w*', re.ASCII)


def c_library_spec(file: ControllerFile) -> ControllerSpec[Controller]:
    """
    Return the controller behind `c_library: {file: libmine.so}`, a path from the YAML file.

    Its options are the global variables in `parameters`.
    """
    keys = mapping(KIND, file.keys(KIND)[KIND], ('file',), optional=('parameters',))
    path = file.named_file(KIND, keys['file'], 'a shared library, compiled first')
    options = _options(keys.get('parameters') or {})
    interface()  # read here, so that each process of a run has it

    def make(context: ControllerContext) -> Controller:
        with file.located():
            return CLibraryController(path, context.gains)

    code = file.compiled_code(KIND, path)
    return ControllerSpec(file.name, make, options, compiled=code)


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
    """Controller in a library that this process has loaded, called at every step."""

    method_names = MappingProxyType(
        {name: f'ddct_controller_{name}' for name in ('reset', 'update', 'hold')}
    )

    def __init__(self, path: Path, parameters: Mapping[str, float] = MappingProxyType({})) -> None:
        """
        Load the library, and set its global variables by name.

        Raise ParameterError when it cannot be used, or lacks a variable.
        """
        self._where = f'{KIND}.file: {path}'
        try:
            self._library = Library(path)
        except LibraryError as error:
            raise ParameterError(f'{self._where}: {error}') from error
        self.preview_steps = self._library.preview_steps
        self.commands_engine = self._library.commands_engine
        for name, value in parameters.items():
            if not self._library.set_variable(name, value):
                key = f'{KIND}.parameters.{name}'
                raise ParameterError(
                    f'{key}: the library has no such variable: declare it outside of all '
                    f'functions as `double {name}`, neither static nor const',
                    key=key,
                )
        self.reset()

    def reset(self) -> None:
        """Call ddct_controller_reset."""
        calling('reset')
        self._library.reset()

    def hold(self, measurement: Measurement) -> None:
        """Call ddct_controller_hold, or reset where there is none."""
        calling('hold', measurement.step)
        self._require_good('hold', measurement, self._library.hold(measurement))

    def update(self, measurement: Measurement) -> Command:
        """Call ddct_controller_update; raise DdctError when it returns an error."""
        calling('update', measurement.step)
        clutch, engine, status = self._library.update(measurement)
        self._require_good('update', measurement, status)
        pairs = (('c_status', str(status)),)
        return Command(clutch, pairs, engine if self.commands_engine else None)

    def _require_good(self, name: str, measurement: Measurement, status: int) -> None:
        if status < 0:
            raise DdctError(
                f'{self._where}: it returned {status} when {name} was called at step '
                f'{measurement.step}: mend the C'
            )
