# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""An instance of an FMU in this process: loaded from files of its own, stepped and freed."""

import os
import weakref
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ddct_controllers.from_file.fmu.unit import Fmu, one_line
from ddct_controllers.from_file.fmu.unpacked import UnpackedFmu
from ddct_plant.program.own_process import keep

_FATAL = 4
"""Status after which no function of an FMU may be called, not even to free it."""
Reference = tuple[int, str]
"""Reference and FMI type of a variable, by which its value is set or read."""


class InstanceError(Exception):
    """A call that failed; the text has the last message that the FMU has logged."""


@dataclass(frozen=True)
class Setting:
    """Variables of an FMU that a controller uses."""

    starts: Sequence[tuple[Reference, Any]]
    """Parameters, each with its start value."""
    inputs: Sequence[Reference]
    outputs: Sequence[Reference]


class Instance:
    """An FMU for co-simulation, FMI 2.0 or 3.0; it ends with this object."""

    def __init__(self, fmu: Fmu, setting: Setting) -> None:
        """Load the FMU; raise InstanceError when that fails."""
        self._setting, self._is_fmi2 = setting, fmu.is_fmi2
        self._messages: list[str] = []
        self._initialised = False
        self._unit, unpacked = self._loaded(fmu)
        self._units = [self._unit]
        self.end = weakref.finalize(self, _end, self._units, unpacked)
        keep(self, self.end)
        try:
            self._set(setting.starts)
        except Exception as error:
            raise self._failed(error) from error

    def _loaded(self, fmu: Fmu) -> tuple[Any, UnpackedFmu]:
        """Return FMPy's object for a new instance, and the instance's files."""
        folder, messages = Path.cwd(), self._messages
        unpacked = None
        try:
            unpacked = UnpackedFmu(fmu.fmpy, fmu.path)
            unit = fmu.fmpy.instantiate_fmu(
                str(unpacked.path),
                fmu.description,
                'CoSimulation',
                # The text comes last in FMI 2.0 and 3.0. A method would keep this object alive.
                logger=lambda *words: messages.append(words[-1].decode('utf-8', 'replace')),
            )
        except Exception as error:
            os.chdir(folder)  # FMPy may be in that of the binary
            if unpacked:
                unpacked.remove()
            raise InstanceError(self._words(error)) from error
        return unit, unpacked

    def step(self, time_s: float, step_s: float, values: Iterable[float]) -> list[float]:
        """Set the inputs, take one step, and return the outputs; raise InstanceError."""
        self._messages.clear()
        inputs = list(zip(self._setting.inputs, values, strict=True))
        try:
            if not self._initialised:
                if self._is_fmi2:
                    self._unit.setupExperiment(startTime=0.0)
                self._unit.enterInitializationMode()
                self._set(inputs)
                self._unit.exitInitializationMode()
                self._initialised = True
            self._set(inputs)
            ended = self._unit.doStep(time_s, step_s)
            outputs = [
                getattr(self._unit, f'get{kind}')([reference])[0]
                for reference, kind in self._setting.outputs
            ]
        except Exception as error:
            raise self._failed(error) from error
        if ended and ended[1]:  # FMI 3.0 returns it; FMI 2.0 fails
            raise InstanceError('it asks for the end of the simulation')
        return outputs

    def _set(self, values: Iterable[tuple[Reference, Any]]) -> None:
        for (reference, kind), value in values:
            getattr(self._unit, f'set{kind}')([reference], [value])

    def _failed(self, error: Exception) -> InstanceError:
        if getattr(error, 'status', None) == _FATAL:
            self._units.clear()
        return InstanceError(self._words(error))

    def _words(self, error: Exception) -> str:
        last = one_line(self._messages[-1]) if self._messages else ''
        return ': '.join(filter(None, (one_line(error), last)))


def _end(units: list[Any], unpacked: UnpackedFmu) -> None:
    """Free an instance, unless it failed fatally, and remove its files."""
    try:
        for unit in units:
            unit.freeInstance()
    finally:
        unpacked.remove()
