# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A column map guessed from names, units and values of a log, and as text to be corrected."""

import itertools
import json
import os
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ddct_bringup.logs.columns import DATE_TIME, HELD, QUANTITIES, TIME, ColumnMap, LogColumn
from ddct_bringup.logs.sources import LogSource
from ddct_plant.base.errors import DdctError

_UNITS: Mapping[str, str] = {
    **dict.fromkeys(('rpm', '1/min', 'min-1', 'u/min', 'rev/min', 'r/min'), 'rpm'),
    **dict.fromkeys(('rad/s', 'rads', 'rad_s'), 'rad/s'),
    **dict.fromkeys(('deg/s', '°/s', 'deg_s'), 'deg/s'),
    **dict.fromkeys(('nm', 'n m', 'n_m', 'n*m', 'n·m'), 'N m'),
    **dict.fromkeys(('km/h', 'kmh', 'km_h', 'kph'), 'km/h'),
    **dict.fromkeys(('m/s', 'm_s', 'mps'), 'm/s'),
    **dict.fromkeys(('m/s2', 'm/s^2', 'm/s²', 'm_s2', 'ms2'), 'm/s^2'),
    **dict.fromkeys(('%', 'pct', 'percent', 'prozent'), '%'),
    **{each: each for each in ('s', 'ms', 'us', 'ns', 'g')},
}
"""Units by how tools write them, in small letters."""
_OF_SI: Mapping[str, tuple[str, ...]] = {
    's': ('s', 'ms', 'us', 'ns'),
    'rad/s': ('rad/s', 'rpm', 'deg/s'),
    'N m': ('N m', '%'),
    'm/s': ('m/s', 'km/h'),
    'm/s^2': ('m/s^2', 'g'),
}
"""Units of a quantity by its SI unit; the first is taken where nothing tells."""
_FASTEST_RAD_S, _FASTEST_M_S, _HIGHEST_M_S2, _LONGEST_STEP_S = 700.0, 20.0, 3.0, 0.2
"""
Values above these are in another unit: rpm, km/h, and ms.

No engine of a car turns at 700 rad/s, and an engagement is slower than 20 m/s. Rows of a log are
closer than 0.2 s.
"""


class _Words(NamedTuple):
    """Words in the name of a quantity's column: one of each group, and none of `without`."""

    groups: tuple[str, ...]
    without: str = ''


_SPEED = r'speed|spd|rpm|drehzahl|rev|n|w|omega'
_ROLLS = r'speed|spd|geschw|geschwindigkeit|v|vel|kmh|rpm|drehzahl|n|w|omega'
_TORQUE_WORDS = r'torque|trq|tq|tor|moment|md'
_TORQUE = rf'{_TORQUE_WORDS}|m|t'
_ENGINE = r'engine|eng|motor|mot|crank|crankshaft|ice'
_CLUTCH = r'clutch\d?|clu|cl\d?|kupplung\d?|kup\d?|k1|k2|c1|c2'
_ASKED = r'request|req|demand|dem|soll|target|tgt|desired|des|cmd|command|setpoint|ref|reference'
_NAMES: Mapping[str, _Words] = {
    TIME: _Words((r'time|zeit|t|timestamp|timestamps|zeitpunkt',)),
    'slip_reference': _Words((r'slip|schlupf', _ASKED)),
    'torque_request': _Words((_CLUTCH, _TORQUE, _ASKED)),
    'torque_demand': _Words((r'driver|fahrer|pedal', _TORQUE)),
    'clutch_torque': _Words((_CLUTCH, _TORQUE), f'{_ASKED}|{_ENGINE}'),
    'driveshaft_torque': _Words(
        (r'driveshaft|halfshaft|axle|seitenwelle|antriebswelle', _TORQUE), _ASKED
    ),
    'load_torque': _Words((r'load|last', _TORQUE)),
    'engine_torque': _Words((_ENGINE, _TORQUE), f'{_ASKED}|{_CLUTCH}|friction|loss'),
    'engine_speed': _Words((_ENGINE, _SPEED), f'{_ASKED}|idle|{_TORQUE_WORDS}'),
    'shaft_speed': _Words(
        (
            r'shaft|input|inp|in\d?|primary|welle|ein|eing|eingang|eingangswelle|getriebeeingang',
            _SPEED,
        ),
        f'{_ASKED}|output|engine|eng|motor|wheel|vehicle|veh|{_TORQUE_WORDS}',
    ),
    'wheel_speed': _Words((r'wheel|whl|rad', _ROLLS), f'{_ASKED}|vehicle'),
    'vehicle_accel': _Words(
        (r'accel|acc|acceleration|beschl|beschleunigung|ax|laengs|längs',),
        f'{_ASKED}|pedal|lateral|lat|y|v|speed',
    ),
    'vehicle_speed': _Words(
        (r'vehicle|veh|car|fahrzeug|fzg|v', r'speed|spd|geschw|v|kmh|vel|x|fzg'),
        f'{_ASKED}|wheel|rad',
    ),
}
"""Words by quantity; the special ones come first, and take their columns."""
_DRIVEN = re.compile(r'fl|fr|vl|vr|front|vorn')
_WHEELS = re.compile(r'[fvrh][lr]|front|rear|vorn|hinten')


@dataclass(frozen=True)
class Guess:
    """A guessed column map, with what it rests on."""

    columns: ColumnMap
    remarks: Mapping[str, str]
    """By quantity what to check, for those whose unit nothing states."""
    left: Sequence[str] = ()
    """Columns that are taken for no quantity."""

    def text(self, log: str, folder: Path, needed: Sequence[str] = ()) -> str:
        """
        Return the map for a folder in YAML, a line for each quantity, with remarks.

        For each `needed` quantity without a column there is a line to be completed, a comment.
        """
        lines = [f'# Guessed from {log}: correct it, and give it as --columns.']
        if self.columns.bus is not None:
            bus = os.path.relpath(self.columns.bus, folder)
            lines.append(f'dbc: {json.dumps(bus, ensure_ascii=False)}')
        lines.append('columns:')
        for name, column in self.columns.columns.items():
            given: dict[str, object] = {
                'column': column.names[0] if len(column.names) == 1 else [*column.names],
                'unit': column.unit,
            }
            given |= {'radius_m': column.radius_m} if column.radius_m else {}
            given |= {'full': column.full} if column.full else {}
            given |= {'between': HELD} if name in self.columns.held else {}
            parts = (f'{key}: {json.dumps(v, ensure_ascii=False)}' for key, v in given.items())
            remark = f'   # {self.remarks[name]}' if name in self.remarks else ''
            lines.append(f'  {name}: {{{", ".join(parts)}}}{remark}')
        missing = [name for name in needed if name not in self.columns.columns]
        for name in missing:
            lines.append(
                f'#  {name}: {{column: "?", unit: "{self._usual_unit(name)}"}}   '
                '# needed: put in its column, and remove the # before it'
            )
        if missing and self.left:
            left = (json.dumps(each, ensure_ascii=False) for each in self.left)
            lines.append(f'# Columns that are not taken: {", ".join(left)}')
        return '\n'.join(lines)

    def _usual_unit(self, quantity: str) -> str:
        """Return the unit that most columns of this kind have; its SI unit without such ones."""
        units = _OF_SI[QUANTITIES[quantity].unit]
        return max(units, key=[each.unit for each in self.columns.columns.values()].count)


def guessed_columns(
    source: LogSource, radius_m: float, full_n_m: float, bus: Path | None = None
) -> Guess:
    """
    Return a column map for a log without one.

    `radius_m` is the wheel radius with which wheel speeds in km/h are angular, `full_n_m` the
    torque that is 100 %. Raise DdctError for a log that cannot be read.
    """
    stated = source.units()
    left = dict.fromkeys(stated)
    found: dict[str, tuple[str, ...]] = {}
    for name, words in _NAMES.items():
        matching = [each for each in left if _matches(words, each)]
        suited = [each for each in matching if _may_be(name, _unit_in(each, stated[each]))]
        if not suited:
            continue
        found[name] = _wheels(suited) if name == 'wheel_speed' else (min(suited, key=len),)
        for each in found[name]:
            del left[each]
    columns, remarks = {}, {}
    for name in (each for each in QUANTITIES if each in found):
        columns[name], remark = _column(source, name, found[name], stated, radius_m, full_n_m)
        if remark:
            remarks[name] = remark
    return Guess(ColumnMap(columns, {}, bus=bus), remarks, [*left])


def _column(
    source: LogSource,
    name: str,
    names: tuple[str, ...],
    stated: Mapping[str, str],
    radius_m: float,
    full_n_m: float,
) -> tuple[LogColumn, str]:
    """Return the column of a quantity, and what to check of it."""
    si_unit = QUANTITIES[name].unit
    unit, remark = _unit_in(names[0], stated[names[0]]), ''
    if not unit:
        unit, remark = _by_values(source, names[0], si_unit)
    if si_unit == 'rad/s' and unit in _OF_SI['m/s']:
        why = 'radius_m is that of the car: put in what the control unit computes with'
        return LogColumn(names, unit, radius_m=float(f'{radius_m:.5g}')), why
    if unit == '%':
        return LogColumn(names, unit, full=full_n_m), 'full is the largest torque of the car'
    return LogColumn(names, unit), remark


def _words(name: str) -> list[str]:
    """Return the words of a name in small letters: `nMot_rpm`, `EngSpd`, `clutch torque`."""
    bare = re.sub(r'[\[(].*?[\])]', ' ', name)
    if ending := _ending(bare):
        bare = bare.strip()[: -len(ending) - 1]
    parts = re.findall(r'[A-ZÄÖÜ]+(?![a-zäöü])\d*|[A-ZÄÖÜ]?[a-zäöüß]+\d*|\d+', bare)
    return [each.lower() for each in parts]


def _matches(words: _Words, name: str) -> bool:
    """Return whether each group has a word of its own in the name, and none is excluded."""
    found = _words(name)
    if words.without and any(re.fullmatch(words.without, each) for each in found):
        return False
    return any(
        all(map(re.fullmatch, words.groups, each))
        for each in itertools.permutations(found, len(words.groups))
    )


def _unit_in(name: str, stated: str) -> str:
    """Return the unit that a file states, or that is in a name; '' for none."""
    if unit := _UNITS.get(stated.strip().lower()):
        return unit
    if bracket := re.search(r'[\[(](.*?)[\])]', name):
        return _UNITS.get(bracket[1].strip().lower(), '')
    return _UNITS.get(_ending(name), '')


def _ending(name: str) -> str:
    """Return the unit after the last underscore but those in it, as written; '' for none."""
    ends = (each for each in _UNITS if name.strip().lower().endswith(f'_{each}'))
    return max(ends, key=len, default='')


def _may_be(name: str, unit: str) -> bool:
    """Return whether a quantity may have a unit; it may where none is known."""
    si_unit = QUANTITIES[name].unit
    units = _OF_SI[si_unit] + (_OF_SI['m/s'] if name == 'wheel_speed' else ())
    return not unit or unit in units


def _by_values(source: LogSource, column: str, si_unit: str) -> tuple[str, str]:
    """Return the unit that the values of a column suggest, with the remark that it is so."""
    try:
        values = source.table([column]).columns[column]
    except DdctError:
        if si_unit == 's':
            return DATE_TIME, 'dates with times'
        raise
    most = float(np.nanmax(np.abs(values), initial=0.0))
    unit = _OF_SI[si_unit][0]
    if si_unit == 's':
        unit = 'ms' if float(np.nanmedian(np.abs(np.diff(values)))) > _LONGEST_STEP_S else 's'
    elif si_unit == 'rad/s' and most > _FASTEST_RAD_S:
        unit = 'rpm'
    elif si_unit == 'm/s' and most > _FASTEST_M_S:
        unit = 'km/h'
    return unit, f'the unit is guessed from the values, up to {most:.4g}'


def _wheels(names: Collection[str]) -> tuple[str, ...]:
    """Return the driven wheels among columns: those of the front where each has a place."""
    placed = [each for each in names if any(_WHEELS.fullmatch(word) for word in _words(each))]
    front = [each for each in placed if any(_DRIVEN.fullmatch(word) for word in _words(each))]
    return tuple(front or placed or [min(names, key=len)])
