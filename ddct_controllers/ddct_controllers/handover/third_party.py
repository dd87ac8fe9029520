# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Handovers of third parties: by the name of an entry point, or in a file of Python."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from ddct_controllers.from_file.python_file import the_one_class
from ddct_controllers.handover.interface import Handover, HandoverCommand, HandoverMeasurement
from ddct_controllers.places import place_of_error
from ddct_controllers.plugins import HANDOVERS
from ddct_plant.base.errors import (
    FOREIGN_FAILURES,
    DdctError,
    ForeignError,
    ParameterError,
    choices_hint,
    require_number,
)
from ddct_plant.files.input_file import without_folder
from ddct_plant.scenario.settings import KnownSettings, is_handover_file
from ddct_plant.shift.balance import LEAST_DEVIATION

_PAGE = 'docs/develop/gear_shift.md'


def third_party_handover(settings: KnownSettings, own: Iterable[str]) -> Handover:
    """
    Return the handover that the run's settings name, with its commands checked.

    `own` are the names of ours, for the error about an unknown one. Raise ParameterError for that
    error, DdctError where the code cannot be loaded or fails.
    """
    name = settings.handover
    made: Callable[[KnownSettings], Any]
    if is_handover_file(name):
        _require_new(settings.handover_name, name, own)
        made = the_one_class(name, Handover, _PAGE)
    else:
        made = _entry_point(name, own)
    try:
        handover = made(settings)
    except DdctError:
        raise
    except FOREIGN_FAILURES as error:
        raise ForeignError(_failure(name, made, 'cannot be made', error)) from error
    if not isinstance(handover, Handover):
        raise DdctError(
            f'handover {name!r}: {made!r} returned {type(handover).__name__}, not a '
            'ddct_controllers.handover.interface.Handover'
        )
    return _Checked(settings, handover)


def _require_new(label: str, file: str, own: Iterable[str]) -> None:
    """Raise ParameterError where a file has the name of another handover in bags and tables."""
    if label in own or HANDOVERS.point(label):
        raise ParameterError(
            f'handover {file!r}: {label} is the name of another handover: rename the file',
            key='handover',
        )


def _entry_point(name: str, own: Iterable[str]) -> Callable[[KnownSettings], Any]:
    if point := HANDOVERS.point(name):
        return HANDOVERS.load(point)
    raise ParameterError(
        f'unknown handover {name!r}: {choices_hint(name, [*own, *HANDOVERS.names()])}, or '
        'give the path of a Python file',
        key='handover',
    )


class _Checked(Handover):
    """A handover of others, whose failures and commands name it."""

    def __init__(self, settings: KnownSettings, handover: Handover) -> None:
        super().__init__(settings)
        # Without the folder: a repetition elsewhere fails with the same reason.
        self._name, self._handover = Path(settings.handover).name, handover

    def update(self, measurement: HandoverMeasurement) -> HandoverCommand:
        """Return its command; raise DdctError for a failure, or for values out of range."""
        try:
            command = self._handover.update(measurement)
        except FOREIGN_FAILURES as error:
            when = f'failed at step {measurement.step}'
            raise ForeignError(_failure(self._name, type(self._handover), when, error)) from error
        if not isinstance(command, HandoverCommand):
            raise DdctError(
                f'handover {self._name!r}: its answer at step {measurement.step} is of type '
                f'{type(command).__name__}: return a HandoverCommand'
            )
        where = f'handover {self._name!r}, step {measurement.step}:'
        return HandoverCommand(
            require_number(f'{where} share', command.share, at_least=0.0, at_most=1.0),
            require_number(f'{where} off_going_request', command.off_going_request),
            require_number(f'{where} torque_cut', command.torque_cut, at_least=0.0),
            require_number(
                f'{where} wear_deviation', command.wear_deviation, at_least=LEAST_DEVIATION
            ),
            require_number(f'{where} torque_offset', command.torque_offset),
        )


def _failure(name: str, made: Any, when: str, error: BaseException) -> str:
    place = place_of_error(error, str(getattr(made, '__module__', '')).partition('.')[0])
    where = f', in {without_folder(place)}' if place else ''
    return f'handover {name!r} {when} ({type(error).__name__}: {error}{where}): mend its code'
