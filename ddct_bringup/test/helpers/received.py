# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that keeps all that it receives, and a search for true values in it."""

import os
import re
import sys
from collections.abc import Iterable, Iterator
from functools import partial
from pathlib import Path
from types import CellType, FunctionType, MethodType, ModuleType
from typing import Any

import numpy as np

from ddct_bringup.run.run_base import RunBase
from ddct_controllers.interface import Command, Controller, ControllerContext, Measurement
from ddct_plant.scenario.case import OF_CASE
from ddct_plant.scenario.choices.settings import SETTINGS
from ddct_plant.scenario.file import ScenarioFile
from ddct_plant.scenario.settings import CaseSettings, RunSettings

UNKNOWN = {
    'wear_gain': 1.1375,
    'seed': 424243,
    'vehicle.mass_kg': 1789.25,
    'actuator.delay_s': 0.013,
}
"""Values that no controller knows, and that no other quantity has."""
UNKNOWN_IN_A_SHIFT = {**UNKNOWN, 'off_going_wear_gain': 0.9125}
_FILE = """
import received_objects

from ddct_controllers.interface import Command, Controller


class Keeper(Controller):
    def __init__(self, context):
        self.context, self.measurements = context, []
        received_objects.KEPT.append(self)

    def reset(self):
        pass

    def hold(self, measurement):
        self.measurements.append(measurement)

    def update(self, measurement):
        self.measurements.append(measurement)
        return Command(-0.1 * measurement.slip_error_rpm)
"""


def keeper_file(folder: Path) -> tuple[str, list[Any]]:
    """Write the controller that keeps all; return its file, and a list of the objects made."""
    module = ModuleType('received_objects')
    kept: list[Any] = []
    module.__dict__['KEPT'] = kept
    sys.modules['received_objects'] = module
    file = folder / 'keeper.py'
    file.write_text(_FILE, encoding='utf-8')
    return str(file), kept


def files_named_in(file: Path) -> set[Path]:
    """Return a file with those that it names, and that these name, without code."""
    found, waiting = set(), [file]
    while waiting:
        each = waiting.pop()
        if each not in found and each.is_file() and each.suffix != '.py':
            found.add(each)
            words = re.split(
                r'[\s"\',:{}\[\]]+', each.read_text(encoding='utf-8', errors='replace')
            )
            waiting += [Path(word) for word in words if word.startswith('/')]
    return found


class Spy(Controller):
    """Controller that searches all that it gets, and what its process was given, for values."""

    def __init__(self, context: ControllerContext, values: Iterable[float], found: Path) -> None:
        """Search context and process for values; note in `found` what is there, at each tick."""
        self.gain = context.gains['gain']
        self._values, self._found = list(values), found
        files = {each for given in sys.argv for each in files_named_in(Path(given))}
        texts = [each.read_text(encoding='utf-8', errors='replace') for each in files]
        process = (sys.argv, dict(os.environ), texts)
        self._note('made', (context, process, context.settings.kind))

    def reset(self) -> None:
        """Keep nothing."""

    def hold(self, measurement: Measurement) -> None:
        """Search a measurement while feedback is off."""
        self._note('held', measurement)

    def update(self, measurement: Measurement) -> Command:
        """Search a measurement; a proportional law."""
        self._note('updated', measurement)
        return Command(-self.gain * measurement.slip_error_rpm)

    def _note(self, what: str, root: object) -> None:
        with self._found.open('a', encoding='utf-8') as file:
            file.write(f'{what} {found_in(root, self._values)}\n')


_SPY = """
import sys
from pathlib import Path

sys.path.append({helpers!r})
import received

from ddct_plant.base.options import Option


class Searching(received.Spy):
    options = {{'gain': Option(0.1, 'gain', 'N m/rpm', at_least=0.0, at_most=1.0)}}

    def __init__(self, context):
        super().__init__(context, {values!r}, Path({found!r}))
"""


def spy_file(folder: Path, values: Iterable[float]) -> tuple[str, Path]:
    """Write the controller that searches for values; return its file, and that of its notes."""
    found, file = folder / 'found.txt', folder / 'searching.py'
    text = _SPY.format(helpers=str(Path(__file__).parent), values=list(values), found=str(found))
    file.write_text(text, encoding='utf-8')
    return str(file), found


def settings_with(
    varied: dict[str, Any], scenario: str = 'launch', **settings: Any
) -> RunSettings:
    """Return the settings of a run whose plant alone has the values that vary."""
    changes = {'duration_s': settings.pop('duration_s', 1.2)}
    assert set(settings) <= set(SETTINGS)
    return RunBase(ScenarioFile.read(scenario), changes, settings, ['Keeper']).at(varied)


def true_values(settings: RunSettings) -> list[float]:
    """Return the values that differ from what a controller knows, the derived inertia too."""
    values, usual = (
        [getattr(case, name) for name in OF_CASE] for case in (settings.case, CaseSettings())
    )
    for found, scenario in ((values, settings.scenario), (usual, settings.known.scenario)):
        found += [scenario.vehicle.mass_kg, scenario.actuator.delay_s]
        found += [scenario.driveline.vehicle_inertia]
    return [value for value, other in zip(values, usual, strict=True) if value != other]


def found_in(root: object, values: Iterable[float]) -> list[float]:
    """Return which of the values are somewhere in an object, as a number or in a text."""
    numbers: set[float] = set()
    texts: list[str] = []
    for each in _within(root):
        if isinstance(each, str):
            texts.append(each)
        elif isinstance(each, np.ndarray):
            numbers.update(np.asarray(each, dtype=float).ravel().tolist())
        else:
            numbers.add(float(each))  # type: ignore[arg-type]
    whole = '\n'.join(texts)
    return [value for value in values if value in numbers or repr(value) in whole]


def numbers_in(root: object) -> bytes:
    """Return the bits of all numbers in an object, at any depth, sorted."""
    found = [
        np.asarray(each, dtype=float).ravel()
        for each in _within(root)
        if not isinstance(each, str)
    ]
    return bytes(np.sort(np.concatenate(found)).tobytes()) if found else b''


def _within(root: object) -> Iterator[object]:
    """Yield numbers, texts and arrays of numbers in an object, at any depth."""
    waiting, before = [root], set()
    while waiting:
        each = waiting.pop()
        if isinstance(each, str | bool | int | float | np.number):
            yield each
            continue
        if isinstance(each, np.ndarray) and each.dtype.kind in 'fiu':
            yield each
            continue
        if id(each) in before or isinstance(each, type | ModuleType):
            continue
        before.add(id(each))
        if isinstance(each, FunctionType):
            cells = (cell for cell in each.__closure__ or () if cell != CellType())
            waiting += [cell.cell_contents for cell in cells]
            waiting += [each.__defaults__, each.__kwdefaults__]
        if isinstance(each, MethodType):
            waiting += [each.__self__, each.__func__]
        elif isinstance(each, partial):
            waiting += [each.func, each.args, each.keywords]
        elif isinstance(each, dict):
            waiting += [*each.keys(), *each.values()]
        elif isinstance(each, list | tuple | set | frozenset):
            waiting += each
        else:
            waiting += vars(each).values() if hasattr(each, '__dict__') else ()
            slots = [
                name for kind in type(each).__mro__ for name in getattr(kind, '__slots__', ())
            ]
            waiting += [getattr(each, name) for name in slots if hasattr(each, name)]
