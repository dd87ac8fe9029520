# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller's library in C: loaded and called in a process of its own (`serving.py`)."""

import json
import math
import re
import struct
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any

HEADER = 'ddct_controller.h'
TEMPLATE = Path(__file__).parent / 'template'
"""Path of the folder with the header and a controller to start from."""
RESET, UPDATE, HOLD, SET = b'ruhs'
"""
First byte of a request; UPDATE and HOLD continue with a measurement as C has it, then references.

SET continues with the values of global variables by name, as JSON.
"""
ANSWER = struct.Struct('ddi')
"""Struct of a reply: clutch and engine torque in N m, and the function's return value."""
MOST_PREVIEW_STEPS = 1000
_EXAMPLE = 'start from the template in docs/controllers/c_controller.md'


class LibraryError(Exception):
    """The library cannot be called."""


class Library:
    """A loaded library with the memory for one controller."""

    def __init__(self, path: str) -> None:
        """Read the interface of the library in a file."""
        # Only here: the program at the other end need not wait for it.
        import cffi

        self._ffi, self._path = cffi.FFI(), path
        self._header = header = (TEMPLATE / HEADER).read_text(encoding='utf-8')
        # cffi reads declarations alone; a macro goes on in the next line after a backslash. An
        # object that is const would be a constant of the compiler's, which it has none of.
        declarations = re.sub(r'^#(.*\\\n)*.*\n', '', header, flags=re.MULTILINE)
        self._ffi.cdef(declarations.replace('extern const ', 'extern '))

    def open(self) -> None:
        """Load it; raise LibraryError when it is missing, no library, or of another interface."""
        ffi = self._ffi
        try:
            self._library = ffi.dlopen(self._path)
        except OSError as error:
            reason = str(error).partition('.  Additionally')[0]
            raise LibraryError(f'it cannot be loaded ({reason})') from error
        (version,) = re.findall(r'define DDCT_INTERFACE_VERSION (\d+)', self._header)
        about = self._symbol('ddct_controller')
        self._require('interface_version', about.interface_version, int(version))
        self._require('measurement_bytes', about.measurement_bytes, ffi.sizeof('ddct_measurement'))
        self._require('command_bytes', about.command_bytes, ffi.sizeof('ddct_command'))
        preview = range(MOST_PREVIEW_STEPS + 1)
        if about.preview_steps not in preview or about.commands_engine not in (0, 1):
            raise LibraryError(
                f'its preview_steps is {about.preview_steps} and its commands_engine '
                f'{about.commands_engine}: give 0 to {MOST_PREVIEW_STEPS} and 0 or 1'
            )
        self.about = {
            'preview_steps': about.preview_steps,
            'commands_engine': bool(about.commands_engine),
        }
        self._calls = {
            RESET: self._symbol('ddct_controller_reset'),
            UPDATE: self._symbol('ddct_controller_update'),
            HOLD: getattr(self._library, 'ddct_controller_hold', None),
        }
        # Of doubles, so that whatever the struct holds is aligned.
        self._state = ffi.new('double[]', about.state_bytes // 8 + 1)
        self._measurement = ffi.new('ddct_measurement *')
        self._references = ffi.new('double[]', 2 * (about.preview_steps + 1))
        self._measurement.slip_reference = self._references
        self._measurement.slip_reference_rate = self._references + about.preview_steps + 1
        before_references = ffi.offsetof('ddct_measurement', 'slip_reference')
        self._scalars = ffi.buffer(self._measurement, before_references)

    def prepared(self) -> AbstractContextManager[object]:
        """Return a context manager that does nothing: a library needs no files."""
        return nullcontext()

    def end(self) -> None:
        """Do nothing: the library's memory ends with its process."""

    def answer(self, request: bytes) -> bytes:
        """Execute one request and return the reply."""
        kind = request[0]
        if kind == SET:
            return ANSWER.pack(0.0, 0.0, self._set(json.loads(request[1:])))
        if kind == RESET or (kind == HOLD and self._calls[HOLD] is None):
            # NaN, so that what is not set shows at once, and not after a second run.
            self._ffi.buffer(self._state)[:] = b'\xff' * self._ffi.sizeof(self._state)
            self._calls[RESET](self._state)
            return ANSWER.pack(0.0, 0.0, 0)
        references = 1 + len(self._scalars)
        self._scalars[:] = request[1:references]
        self._ffi.buffer(self._references)[:] = request[references:]
        if kind == HOLD:
            return ANSWER.pack(0.0, 0.0, self._calls[HOLD](self._state, self._measurement))
        command = self._ffi.new('ddct_command *', (math.nan, math.nan))
        status = self._calls[UPDATE](self._state, self._measurement, command)
        return ANSWER.pack(command.clutch_torque, command.engine_torque, status)

    def _set(self, values: dict[str, float]) -> int:
        """Set global variables of C; return 0, or minus the place, from 1, of a missing one."""
        import cffi

        for place, (name, value) in enumerate(values.items(), start=1):
            try:
                self._ffi.cdef(f'extern double {name};')
                setattr(self._library, name, value)
            except (AttributeError, KeyError, cffi.CDefError, cffi.FFIError):
                return -place
        return 0

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


def load(path: str) -> Library:
    """Return the library in a file, not loaded yet."""
    return Library(path)
