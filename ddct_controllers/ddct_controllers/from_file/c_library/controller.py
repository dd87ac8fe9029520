# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller in a shared library, and the loader of `c_library`."""

import contextlib
import struct
import weakref
from operator import attrgetter
from pathlib import Path
from types import MappingProxyType

from ddct_controllers.from_file.c_library import host
from ddct_controllers.from_file.c_library.loaded import (
    LoadedLibrary,
    end_process,
    exit_text,
    loaded_library,
    received,
)
from ddct_controllers.from_file.controller_file import ControllerFile, mapping
from ddct_controllers.interface import (
    UNSTATED,
    Command,
    Controller,
    ControllerContext,
    ControllerSpec,
    Measurement,
)
from ddct_plant.base.errors import DdctError

KIND = 'c_library'
_SCALARS = attrgetter(
    *('step', 'engine_speed', 'shaft_speed', 'wheel_speed', 'vehicle_speed'),
    *('engine_torque', 'load_torque', 'open_loop_torque'),
)
"""Scalars of a measurement, in the order of the struct ddct_measurement."""
_CALLS = {host.RESET: 'reset', host.UPDATE: 'update', host.HOLD: 'hold'}


def c_library_spec(file: ControllerFile) -> ControllerSpec[Controller]:
    """Return the controller behind `c_library: {file: libmine.so}`, a path from the YAML file."""
    content = mapping(KIND, file.keys(KIND)[KIND], ('file',))['file']
    path = file.named_file(KIND, content, 'a shared library, compiled first')

    libraries: list[LoadedLibrary] = []

    def make(context: ControllerContext) -> Controller:
        with file.located():
            controller = CLibraryController(path)
        libraries[:] = [controller.library]  # it stays loaded between the runs of a campaign
        return controller

    return ControllerSpec(file.name, make, {}, UNSTATED)


class CLibraryController(Controller):
    """Controller whose library runs in a process of its own, called at every step."""

    method_names = MappingProxyType({name: f'ddct_controller_{name}' for name in _CALLS.values()})

    def __init__(self, path: Path) -> None:
        """Start its process; raise ParameterError when the library cannot be used."""
        self._where = f'{KIND}.file: {path}'
        self.library = loaded_library(path, self._where)
        self.preview_steps = self.library.preview_steps
        self.commands_engine = self.library.commands_engine
        self._channel, self._process = self.library.start()
        self._end = weakref.finalize(self, end_process, self._channel, self._process)
        self._layout = struct.Struct(f'q7d{2 * (self.preview_steps + 1)}d')

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

    def _call(self, call: int, measurement: Measurement | None = None) -> tuple[float, float, int]:
        request, when = bytes([call]), f'{_CALLS[call]} was called'
        if measurement is not None:
            when += f' at step {measurement.step}'
            references = (*measurement.slip_reference, *measurement.slip_reference_rate)
            request += self._layout.pack(*_SCALARS(measurement), *references)
        with contextlib.suppress(OSError):  # it ended before; `_received` raises
            self._channel.send(request)
        clutch, engine, status = host.ANSWER.unpack(self._received(when))
        if status < 0:
            self._end()
            raise DdctError(f'{self._where}: it returned {status} when {when}: mend the C')
        return clutch, engine, status

    def _received(self, when: str) -> bytes:
        """Return the next message; raise DdctError when the process ended instead."""
        answer = received(self._channel)
        if len(answer) > host.EXITED.size:
            return answer
        (code,) = host.EXITED.unpack(answer) if answer else (0,)
        self._end()
        raise DdctError(f'{exit_text(code)} when {when}: mend the C', place=self._where)
