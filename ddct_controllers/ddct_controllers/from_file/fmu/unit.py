# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
A functional mock-up unit (FMU) for co-simulation, FMI 2.0 or 3.0: its file and description.

FMPy, an optional extra, reads the file and calls the binary in it; nothing else imports it.
"""

import math
import re
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.base.timebase import PERIOD_S

_IDENTIFIER = re.compile(r'[A-Za-z_]\w*', re.ASCII)
_MOST_STEPS = 1e6
"""Limit of the number of steps of an FMU in a period."""


class Fmu:
    """Description of the FMU in a file, checked to suit this machine and our period."""

    def __init__(self, path: Path) -> None:
        """Read the file; raise ParameterError, or DdctError without FMPy, with what to do."""
        self.path = path
        self.fmpy = _fmpy()
        try:
            with zipfile.ZipFile(path) as file:
                names = file.namelist()
            self.description = self.fmpy.read_model_description(path, validate=False)
        except Exception as error:
            raise ParameterError(
                f'{path} is no FMU ({one_line(error)}): export it again'
            ) from error
        version = self.description.fmiVersion
        if not version.startswith(('2.', '3.')) or self.description.coSimulation is None:
            raise ParameterError(
                f'{path} is not for co-simulation by FMI 2.0 or 3.0 (FMI {version}): export it so'
            )
        self.is_fmi2 = version.startswith('2.')
        self.variables: Mapping[str, Any] = {v.name: v for v in self.description.modelVariables}
        """FMPy's `ModelVariable` by name."""
        self._require_binary(names)
        self._require_period()

    def _require_binary(self, names: Sequence[str]) -> None:
        platform = self.fmpy.platform if self.is_fmi2 else self.fmpy.platform_tuple
        identifier = self.description.coSimulation.modelIdentifier or ''
        if not _IDENTIFIER.fullmatch(identifier):  # it is a part of the path of the binary
            raise ParameterError(
                f'{self.path}: its modelIdentifier is {identifier!r}: export it again, with '
                'letters, digits and underscores'
            )
        if f'binaries/{platform}/{identifier}{self.fmpy.sharedLibraryExtension}' in names:
            return
        parts = [name.split('/') for name in names]
        there = sorted({part[1] for part in parts if part[0] == 'binaries' and len(part) > 2})
        raise ParameterError(
            f'{self.path} has no binary for {platform}, but for {", ".join(there) or "none"}: '
            'export it for this platform, or compile the sources in it with `fmpy compile`'
        )

    def _require_period(self) -> None:
        """Raise ParameterError when the FMU has a fixed step that does not divide our period."""
        unit, experiment = self.description.coSimulation, self.description.defaultExperiment
        stated = unit.fixedInternalStepSize or (experiment and experiment.stepSize)
        if unit.canHandleVariableCommunicationStepSize or not stated:
            return
        step = number_in(stated)
        steps = PERIOD_S / step if step > 0.0 else math.inf
        if not 0.5 < steps < _MOST_STEPS or abs(steps - round(steps)) > 1e-6:
            raise ParameterError(
                f'{self.path} has a fixed step of {stated} s: export it with {PERIOD_S} s, or a '
                'step that goes into it'
            )


def number_in(text: object) -> float:
    """Return a number of the description, NaN for another text."""
    try:
        return float(str(text))
    except ValueError:
        return math.nan


def one_line(text: object) -> str:
    """Return the text on one line, without a full stop."""
    return ' '.join(str(text).split()).rstrip('.')


def _fmpy() -> Any:
    try:
        import fmpy
    except ImportError as error:
        raise DdctError(
            'fmu: FMPy is not installed: `make setup EXTRAS=fmu`, or '
            '`python -m pip install fmpy` where numpy '
            'is 2.1 or newer'
        ) from error
    return fmpy
