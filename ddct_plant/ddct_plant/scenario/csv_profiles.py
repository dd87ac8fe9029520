# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Profiles from CSV files and profiles times a factor; a loaded scenario contains the points."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import (
    REQUIRED,
    Option,
    OptionGroup,
    Options,
    options_of,
    require_known,
)
from ddct_plant.base.profile import TIME, value_names
from ddct_plant.base.units import si_unit_of, si_values
from ddct_plant.files.csv_table import CsvTable, read_csv
from ddct_plant.files.input_file import located, named_in
from ddct_plant.models.engine import TorqueProfile
from ddct_plant.models.load import BrakeProfile, SlopeProfile
from ddct_plant.scenario.control import EngineSpeedReference, SlipProfile

MOST_ROWS = 2000
"""Most rows of one file; a scenario with all profiles of this size fits into a bag."""
_PROFILES: tuple[type[OptionGroup], ...] = (
    TorqueProfile,
    EngineSpeedReference,
    BrakeProfile,
    SlopeProfile,
    SlipProfile,
)
SECTIONS = {group.prefix.rstrip('.'): group for group in _PROFILES}
"""Sections with a profile, by their key."""
_FILE = 'csv'
FILE_KEY = f'.{_FILE}'
"""End of the key of a file with a profile."""
FACTOR = 'factor'
"""Key of the factor of a profile; a loaded scenario does not have it."""
FACTOR_OPTION = Option(1.0, 'by which the values of a profile are multiplied')
_SOURCE: Options = {
    _FILE: Option(REQUIRED, 'the file', kind=str),
    'time': Option(REQUIRED, 'its column of times', kind=str),
    'value': Option(REQUIRED, 'its column of values', kind=str),
    'unit': Option(REQUIRED, 'unit of the values', kind=str),
    'time_unit': Option('s', 'unit of the times'),
    'start_s': Option(0.0, "the file's time at scenario time 0", 's'),
}
"""Options of a section that describe its CSV file."""


def with_file_in(folder: Path, section: Any) -> Any:
    """Return a section whose CSV file, relative to `folder`, is named from anywhere."""
    if isinstance(section, Mapping) and isinstance(section.get(_FILE), str):
        return {**section, _FILE: str(named_in(folder, section[_FILE]))}
    return section


def file_of(section: Any) -> Path | None:
    """Return the CSV file of a section, None without one."""
    named = isinstance(section, Mapping) and isinstance(section.get(_FILE), str)
    return Path(section[_FILE]) if named else None


def replaced(name: str, base: Mapping[str, Any], own: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a profile of a base keeps beside the values of another one of this section."""
    if _FILE in own:
        return {}
    values = value_names(SECTIONS[name])
    if not {TIME, *values} & own.keys():
        return dict(base)
    gone = {*_SOURCE, FACTOR, *(values if set(values) & own.keys() else ())}
    return {key: value for key, value in base.items() if key not in gone}


def with_points(content: Mapping[str, Any], set_keys: Iterable[str]) -> dict[str, Any]:
    """
    Return the content of a scenario with the points of its CSV files in place of their names.

    A section may be `{csv: FILE, time: COLUMN, value: COLUMN, unit: UNIT}`, with `time_unit` and
    `start_s`, the file's time in s at scenario time 0. The values of a section with `factor` are
    multiplied by it. What `--set` gives by its keys `set_keys`, a file or points in one quantity,
    takes the place of what the file has in another way.
    Raise ParameterError that names file, line and column.
    """
    content, given = dict(content), set(set_keys)
    for name, group in SECTIONS.items():
        section = content.get(name)
        if not isinstance(section, Mapping):
            continue
        values = value_names(group)
        if not {_FILE, FACTOR, *values[1:]} & section.keys():
            continue
        section = dict(section)
        factor = FACTOR_OPTION.checked(
            f'{name}.{FACTOR}', section.pop(FACTOR, FACTOR_OPTION.default)
        )
        section = _as_set(section, name, values, given)
        if _FILE in section:
            section = _points(section, group)
        content[name] = section if factor == 1.0 else _scaled(section, values, factor)
    return content


def described_profiles(content: Mapping[str, Any], set_keys: Iterable[str]) -> dict[str, Any]:
    """
    Return the sections of a scenario's content that a CSV file or a factor describes.

    They are those without points of `--set`, whose keys are `set_keys`, in their place.
    """
    given = set(set_keys)
    return {
        name: content[name]
        for name, group in SECTIONS.items()
        if isinstance(content.get(name), Mapping)
        and {_FILE, FACTOR} & content[name].keys()
        and not {f'{name}.{each}' for each in (TIME, *value_names(group))} & given
    }


def _scaled(section: dict[str, Any], values: Iterable[str], factor: float) -> dict[str, Any]:
    """Return a section with its values multiplied; values that are no numbers stay unchanged."""
    scaled = dict(section)
    for value in values:
        points = section.get(value)
        if isinstance(points, Sequence) and all(type(each) in (int, float) for each in points):
            scaled[value] = [factor * each for each in points]
    return scaled


def _as_set(
    section: dict[str, Any], name: str, values: Sequence[str], given: set[str]
) -> dict[str, Any]:
    """
    Return a section without what --set replaces.

    A file from there replaces points, points replace a file, and values replace values in another
    quantity.
    """
    points = {TIME, *values}
    if set_values := [value for value in values if f'{name}.{value}' in given]:
        other = set(values).difference(set_values)
        section = {key: item for key, item in section.items() if key not in other}
    if _FILE not in section or not points & set(section):
        return section
    if f'{name}.{_FILE}' in given:
        return {key: item for key, item in section.items() if key not in points}
    if any(f'{name}.{key}' in given for key in points):
        return {key: item for key, item in section.items() if key not in _SOURCE}
    raise ParameterError(f'{name} has points and {name}.{_FILE}: give one of them', key=name)


def _points(section: Mapping[str, Any], group: type[OptionGroup]) -> dict[str, Any]:
    prefix = group.prefix
    require_known(section, _SOURCE, prefix=prefix)
    spec = {key: section.get(key, described.default) for key, described in _SOURCE.items()}
    if missing := [f'{prefix}{key}' for key, value in spec.items() if value is REQUIRED]:
        raise ParameterError(
            f'{prefix}{_FILE} needs {", ".join(missing)} beside it: give all keys of the '
            'file, such as {csv: pedal.csv, time: t, value: torque, unit: N m}',
            key=missing[0],
        )
    for key, described in _SOURCE.items():
        described.checked(f'{prefix}{key}', spec[key])
    with located(f'{prefix}{_FILE}'):
        return _read(spec, group)


def _read(spec: Mapping[str, Any], group: type[OptionGroup]) -> dict[str, Any]:
    """Return the checked points of the file that `spec` describes."""
    names, options = [spec['time'], spec['value']], options_of(group)
    units = {options[name].unit: name for name in value_names(group)}
    unit = si_unit_of(spec['unit'], tuple(units))
    file = named_in(Path(), spec[_FILE])
    table = read_csv(file, names)
    times, values = (table.columns[name] for name in names)
    if len(times) > MOST_ROWS:
        raise ParameterError(
            f'it has {len(times)} rows: give at most {MOST_ROWS}',
            place=table.place(MOST_ROWS, names[0]),
        )
    times = si_values(times, spec['time_unit'], 's') - spec['start_s']
    values = si_values(values, spec['unit'], unit)
    points = {TIME: times.tolist(), units[unit]: values.tolist()}
    _check(table, dict(zip(points, names, strict=True)), points, group)
    return points


def _check(
    table: CsvTable,
    columns: Mapping[str, str],
    points: Mapping[str, Any],
    group: type[OptionGroup],
) -> None:
    """Refuse values out of range, times that do not rise, and a late start; name their place."""
    for name in points:
        described = options_of(group)[name]
        one = replace(described, many=False, default=REQUIRED)
        for row, number in enumerate(points[name]):
            try:
                one.checked(f'{group.prefix}{name}', number)
            except ParameterError as error:
                # The key of the points may stand in the base of the file that names this one.
                raise ParameterError(
                    error, key=f'{group.prefix}{_FILE}', place=table.place(row, columns[name])
                ) from error
    times = points[TIME]
    for row, (earlier, later) in enumerate(zip(times, times[1:], strict=False), 1):
        if later <= earlier:
            raise ParameterError(
                f'the time goes from {earlier:g} to {later:g} s: it must rise',
                place=table.place(row, columns[TIME]),
            )
    if times[0] > 0.0:
        raise ParameterError(
            f'the profile begins at scenario time {times[0]:g} s: it must cover the start, so '
            'give an earlier row or start_s',
            place=table.place(0, columns[TIME]),
        )
