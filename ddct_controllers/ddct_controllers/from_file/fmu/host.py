# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""An FMU: unpacked, loaded and stepped in a process of its own (`serving.py`)."""

import json
import struct
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from tempfile import TemporaryDirectory
from typing import Any, TypedDict

_LOAD = ord('l')
"""
First byte of the first request, which continues with a `Setting` as JSON.

Each other request has the byte 's', and as doubles the time and length of a step in s and the
inputs.
"""
_FOLDER = 'ddct_fmu_'
"""Beginning of the name of the temporary folder with the unpacked files of a controller."""
_FATAL = 4
"""Status after which no function of an FMU may be called, not even to free it."""


class Setting(TypedDict):
    """Variables of an FMU that a controller uses, by their references and FMI types."""

    starts: Sequence[tuple[int, str, Any]]
    """Parameters, each with its start value."""
    inputs: Sequence[tuple[int, str]]
    outputs: Sequence[tuple[int, str]]


class Unit:
    """An FMU for co-simulation, FMI 2.0 or 3.0."""

    about = None

    def __init__(self, path: str) -> None:
        """Read the description of the FMU in a file, which was checked before."""
        # Only here: an optional extra.
        import fmpy

        self._fmpy, self._path = fmpy, path
        self._description = fmpy.read_model_description(path, validate=False)
        self._is_fmi2 = self._description.fmiVersion.startswith('2.')
        self._message = ''
        self._instance: Any = None
        self._folder = ''

    def open(self) -> None:
        """Do nothing: each controller loads the binary in its own process."""

    @contextmanager
    def prepared(self) -> Iterator[None]:
        """Unpack the files into a temporary folder, which is removed at the end."""
        with TemporaryDirectory(prefix=_FOLDER, ignore_cleanup_errors=True) as self._folder:
            self._fmpy.extract(self._path, self._folder)
            yield

    def answer(self, request: bytes) -> bytes:
        """Execute one request; an error has the last message that the FMU has logged."""
        self._message = ''
        try:
            if request[0] == _LOAD:
                self._load(json.loads(request[1:]))
                return b''
            return self._step(*struct.unpack(f'{len(request) // 8}d', request[1:]))
        except Exception as error:
            if getattr(error, 'status', None) == _FATAL:
                self._instance = None
            words = filter(None, (_one_line(error), self._message))
            raise RuntimeError(': '.join(words)) from error

    def end(self) -> None:
        """Free the instance of the FMU."""
        if self._instance:
            self._instance.freeInstance()

    def _load(self, setting: Setting) -> None:
        self._inputs, self._outputs = setting['inputs'], setting['outputs']
        self._initialised = False
        self._instance = self._fmpy.instantiate_fmu(
            self._folder, self._description, 'CoSimulation', logger=self._log
        )
        self._set(setting['starts'])

    def _step(self, time_s: float, step_s: float, *values: float) -> bytes:
        """Set the inputs, take one step, and return the outputs as doubles."""
        inputs = [(*each, value) for each, value in zip(self._inputs, values, strict=True)]
        if not self._initialised:
            if self._is_fmi2:
                self._instance.setupExperiment(startTime=0.0)
            self._instance.enterInitializationMode()
            self._set(inputs)
            self._instance.exitInitializationMode()
            self._initialised = True
        self._set(inputs)
        ended = self._instance.doStep(time_s, step_s)
        if ended and ended[1]:  # FMI 3.0 returns it; FMI 2.0 fails
            raise RuntimeError('it asks for the end of the simulation')
        outputs = [
            getattr(self._instance, f'get{kind}')([reference])[0]
            for reference, kind in self._outputs
        ]
        return struct.pack(f'{len(outputs)}d', *outputs)

    def _set(self, values: Iterable[tuple[int, str, Any]]) -> None:
        for reference, kind, value in values:
            getattr(self._instance, f'set{kind}')([reference], [value])

    def _log(self, *message: Any) -> None:
        """Store the last message of the FMU; its text comes last in FMI 2.0 and 3.0."""
        self._message = _one_line(message[-1].decode('utf-8', 'replace'))


def _one_line(text: object) -> str:
    """Return the text on one line, without a full stop."""
    return ' '.join(str(text).split()).rstrip('.')


def load(path: str) -> Unit:
    """Return the FMU in a file."""
    return Unit(path)
