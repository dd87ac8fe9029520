# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller's library in C: loaded into this process, checked and called."""

import math
import re
import struct
from functools import cache
from operator import attrgetter
from pathlib import Path
from typing import Any

from ddct_controllers.measurement import Measurement

HEADER = 'ddct_controller.h'
TEMPLATE = Path(__file__).parent / 'template'
"""Path of the folder with the header and a controller to start from."""
MOST_PREVIEW_STEPS = 1000
_SCALARS = attrgetter(
    *('step', 'engine_speed', 'shaft_speed', 'wheel_speed', 'vehicle_speed'),
    *('engine_torque', 'load_torque', 'open_loop_torque'),
)
"""Scalars of a measurement, in the order of the struct ddct_measurement."""
_LAYOUT = struct.Struct('q7d')
_EXAMPLE = 'start from the template in docs/controllers/files.md'


class LibraryError(Exception):
    """The library cannot be called."""


class Library:
    """A loaded library with the memory for one controller."""

    def __init__(self, path: Path) -> None:
        """Load a file; raise LibraryError for one that is no library, or of another interface."""
        self._ffi, version = interface()
        self._path = str(path.resolve())
        try:
            self._library = self._ffi.dlopen(self._path)
        except OSError as error:
            reason = str(error).partition('.  Additionally')[0]
            raise LibraryError(f'it cannot be loaded ({reason})') from error
        about = self._symbol('ddct_controller')
        self._require('interface_version', about.interface_version, version)
        for name in ('measurement', 'command'):
            size = self._ffi.sizeof(f'ddct_{name}')
            self._require(f'{name}_bytes', getattr(about, f'{name}_bytes'), size)
        preview = range(MOST_PREVIEW_STEPS + 1)
        if about.preview_steps not in preview or about.commands_engine not in (0, 1):
            raise LibraryError(
                f'its preview_steps is {about.preview_steps} and its commands_engine '
                f'{about.commands_engine}: give 0 to {MOST_PREVIEW_STEPS} and 0 or 1'
            )
        self.preview_steps = int(about.preview_steps)
        self.commands_engine = bool(about.commands_engine)
        self._reset = self._symbol('ddct_controller_reset')
        self._update = self._symbol('ddct_controller_update')
        self._hold = getattr(self._library, 'ddct_controller_hold', None)
        self._allocate(about.state_bytes)

    def _allocate(self, state_bytes: int) -> None:
        """Allocate the state, and what the functions read and write."""
        ffi, entries = self._ffi, self.preview_steps + 1
        # Of doubles, so that whatever the struct holds is aligned.
        self._state = ffi.new('double[]', state_bytes // 8 + 1)
        self._state_bytes = ffi.buffer(self._state)
        self._measurement = ffi.new('ddct_measurement *')
        self._scalars = ffi.buffer(self._measurement)
        self._references = ffi.new('double[]', 2 * entries)
        self._measurement.slip_reference = self._references
        self._measurement.slip_reference_rate = self._references + entries
        self._command = ffi.new('ddct_command *')

    def set_variable(self, name: str, value: float) -> bool:
        """Set a global variable of C; return whether the library has it."""
        import cffi

        own = cffi.FFI()
        try:
            own.cdef(f'extern double {name};')
            setattr(own.dlopen(self._path), name, value)
        except (AttributeError, KeyError, cffi.CDefError, cffi.FFIError):
            return False
        return True

    def reset(self) -> None:
        """Call ddct_controller_reset."""
        # NaN, so that what is not set shows at once, and not after a second run.
        self._state_bytes[:] = b'\xff' * len(self._state_bytes)
        self._reset(self._state)

    def hold(self, measurement: Measurement) -> int:
        """Call ddct_controller_hold, or reset where there is none; return its value, or 0."""
        if self._hold is None:
            self.reset()
            return 0
        self._write(measurement)
        return int(self._hold(self._state, self._measurement))

    def update(self, measurement: Measurement) -> tuple[float, float, int]:
        """Return torques of clutch and engine in N m, and the function's return value."""
        self._write(measurement)
        command = self._command
        command.clutch_torque = command.engine_torque = math.nan
        status = self._update(self._state, self._measurement, command)
        return command.clutch_torque, command.engine_torque, status

    def _write(self, measurement: Measurement) -> None:
        """Write a measurement as C has it."""
        _LAYOUT.pack_into(self._scalars, 0, *_SCALARS(measurement))
        self._references[0 : len(self._references)] = [
            *measurement.slip_reference,
            *measurement.slip_reference_rate,
        ]

    def _symbol(self, name: str) -> Any:
        try:
            return getattr(self._library, name)
        except (AttributeError, KeyError) as error:  # of a function, of an object
            raise LibraryError(f'it has no {name}: include {HEADER}, and {_EXAMPLE}') from error

    def _require(self, name: str, found: int, expected: int) -> None:
        if found != expected:
            raise LibraryError(
                f'its {name} is {found}, this version has {expected}: compile it with the '
                f'{HEADER} of this version, for this machine'
            )


@cache
def interface() -> tuple[Any, int]:
    """Return cffi's reading of the header, and the version of the interface in it."""
    # Only here: most programs run no library.
    import cffi

    ffi, header = cffi.FFI(), (TEMPLATE / HEADER).read_text(encoding='utf-8')
    # cffi reads declarations alone; a macro goes on in the next line after a backslash. An
    # object that is const would be a constant of the compiler's, which it has none of.
    declarations = re.sub(r'^#(.*\\\n)*.*\n', '', header, flags=re.MULTILINE)
    ffi.cdef(declarations.replace('extern const ', 'extern '))
    (version,) = re.findall(r'define DDCT_INTERFACE_VERSION (\d+)', header)
    return ffi, int(version)
