# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The settings of a run as one JSON: in its bag, and in the files from which its nodes get them.

It has two parts. `known` is what every node and controller knows, `case` what the plant alone has.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from ddct_plant.base.clutch_kinds import LINEAR
from ddct_plant.base.errors import DdctError, ParameterError, require_name, require_number
from ddct_plant.base.options import options_of
from ddct_plant.base.timebase import LONGEST_S, PERIOD_S, steps_in
from ddct_plant.files.json_records import from_json, json_line, parse_json, read_json
from ddct_plant.scenario.content import scenario_content, scenario_from_mapping
from ddct_plant.scenario.differences import values_by_key
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings, is_handover_file

SETTINGS = 'settings'
"""Key of the JSON in the custom data of a bag."""
SCHEMA = 1
"""Version of the keys of the JSON; those of the scenarios in it have the same."""
_NAMES = ('controller', 'architecture', 'mode')
_NOT_COMPARED = ('description', 'adjusted')
"""Keys of a scenario that change nothing in a run."""
_ABSENT = 'left out'


@dataclass(frozen=True)
class KnownRecord:
    """Settings that every node of a run has, and every controller knows."""

    controller: str
    """Name of the controller, in tables and of the bag."""
    duration_s: float
    """Planned duration of the run, s."""
    architecture: str
    mode: str
    handover: str | None
    """Name of the handover of a gear shift; None in other runs."""
    scenario: dict[str, Any]
    """Content of the scenario's file, whole."""

    def __post_init__(self) -> None:
        """Raise ParameterError for a name that tables and files could not have."""
        for name in _NAMES:
            require_name(name, getattr(self, name))
        require_number(
            'duration_s', self.duration_s, unit='s', at_least=PERIOD_S, at_most=LONGEST_S
        )
        if self.handover is None:
            return
        require_name('handover', self.handover)
        if is_handover_file(self.handover):  # a bag is data alone: its settings run no file
            raise ParameterError(
                f'handover is {self.handover!r}, a file: give a name without .py', key='handover'
            )

    @property
    def clutch(self) -> str:
        """Name of the clutch model."""
        return str(self.scenario.get('clutch', LINEAR))

    @property
    def steps(self) -> int:
        """Planned number of periods; raise ParameterError for a duration that no run has."""
        return steps_in('duration_s', self.duration_s)


@dataclass(frozen=True)
class CaseRecord:
    """True settings of a run that controllers, handovers and the reference do not know."""

    wear_gain: float
    seed: int
    off_going_wear_gain: float | None
    """Wear gain of the off-going clutch of a gear shift; None in other runs."""
    scenario: dict[str, Any]
    """
    Values of the true scenario that differ from those known, as a merge patch (RFC 7396).

    None stands for a value that the true scenario leaves out.
    """


@dataclass(frozen=True)
class KnownPart:
    """Content of the file with the known settings, which every node reads."""

    schema_version: int
    known: KnownRecord


@dataclass(frozen=True)
class CasePart:
    """Content of the file with the rest of the settings, which nodes of the plant read."""

    schema_version: int
    case: CaseRecord


@dataclass(frozen=True)
class RecordedSettings:
    """Settings of a run as its bag has them."""

    schema_version: int
    known: KnownRecord
    case: CaseRecord

    @classmethod
    def of(cls, settings: RunSettings, controller: str, duration_s: float) -> 'RecordedSettings':
        """Return the record of a run with the controller of this name."""
        known, case = settings.known, settings.case
        shift, of_known = known.shift, scenario_content(known.scenario)
        return cls(
            SCHEMA,
            KnownRecord(
                controller=controller,
                duration_s=duration_s,
                architecture=known.architecture,
                mode=known.mode,
                handover=known.handover_name if shift else None,
                scenario=of_known,
            ),
            CaseRecord(
                wear_gain=float(case.wear_gain),
                seed=case.seed,
                off_going_wear_gain=float(case.off_going_wear_gain) if shift else None,
                scenario=_patch(of_known, scenario_content(settings.scenario)),
            ),
        )

    @property
    def parts(self) -> tuple[KnownPart, CasePart]:
        """The two parts, for a file each."""
        return KnownPart(SCHEMA, self.known), CasePart(SCHEMA, self.case)

    def text(self) -> str:
        """Return the JSON text in one line; numbers keep every bit."""
        return json_line(self)


def settings_of_bag(custom_data: Mapping[str, str]) -> RecordedSettings:
    """
    Return the settings in the custom data of a bag.

    Raise DdctError for a bag without, of another version of the schema, or with bad values.
    """
    if SETTINGS not in custom_data:
        raise DdctError(
            f'no {SETTINGS} in the custom data: not a recording of this project', key=SETTINGS
        )
    try:
        data = parse_json(custom_data[SETTINGS])
    except ParameterError as error:
        raise error.at(f'{SETTINGS} of the run') from error
    return from_json(RecordedSettings, data, f'{SETTINGS} of the run', newest=SCHEMA)


Part = TypeVar('Part', bound=KnownPart | CasePart)


def read_part(kind: type[Part], file: str) -> Part:
    """Return the part of a run's settings in a file; raise DdctError that names the file."""
    return read_json(kind, Path(file), newest=SCHEMA)


def known_settings(record: KnownRecord) -> KnownSettings:
    """Return the known settings of a record; raise DdctError for values that make no run."""
    return KnownSettings(
        _scenario(record.scenario),
        architecture=record.architecture,
        mode=record.mode,
        **({} if record.handover is None else {'handover': record.handover}),
    )


def run_settings(known: KnownRecord, case: CaseRecord) -> RunSettings:
    """Return the settings of a run; raise DdctError for values that make none."""
    settings = known_settings(known)
    return RunSettings(settings, case_settings(settings, case))


def case_settings(known: KnownSettings, record: CaseRecord) -> CaseSettings:
    """Return the case of a record of a run with these known settings; raise DdctError as there."""
    off_going, patch = record.off_going_wear_gain, record.scenario
    return CaseSettings(
        wear_gain=record.wear_gain,
        seed=record.seed,
        **({} if off_going is None else {'off_going_wear_gain': off_going}),
        scenario=_scenario(_merged(scenario_content(known.scenario), patch)) if patch else None,
    )


def values_of(settings: RunSettings) -> dict[str, object]:
    """
    Return the values of all settings by key, to be compared.

    Keys of scenarios are dotted, below `scenario` and `case.scenario`. A handover has its name.
    """
    case = settings.case
    return {
        **known_values(settings.known),
        **{name: getattr(case, name) for name in options_of(CaseSettings)},
        **values_of_scenario('case.scenario', settings.scenario),
    }


def known_values(known: KnownSettings) -> dict[str, object]:
    """Return the values of the known settings by key, as `values_of` has them."""
    return {
        **{name: getattr(known, name) for name in options_of(KnownSettings)},
        'handover': known.handover_name,
        **values_of_scenario('scenario', known.scenario),
    }


def values_text(values: Mapping[str, object]) -> str:
    """Return values of settings as JSON, for another node to compare."""
    return json_line(values)


def values_of_scenario(name: str, scenario: Scenario) -> dict[str, object]:
    """Return the values of a scenario that change a run, by dotted key below `name`."""
    values = values_by_key(scenario)
    return {f'{name}.{key}': values[key] for key in values if key not in _NOT_COMPARED}


def require_agreement(node: str, ours: Mapping[str, object], theirs: Mapping[str, object]) -> None:
    """Raise ParameterError for the first setting of a node that differs from that of the run."""
    for key in (*ours, *theirs):
        mine, others = ours.get(key, _ABSENT), theirs.get(key, _ABSENT)
        if mine != others:
            raise ParameterError(
                f'node {node} has {key} {mine}, but the settings of the run have {others}: '
                'start every node with the same settings',
                key=key,
            )


def require_same(node: str, ours: Mapping[str, object], text: str) -> None:
    """Raise the errors of `require_agreement` for the values in a text of `values_text`."""
    theirs = from_json(dict[str, Any], parse_json(text), 'the settings of the run')
    require_agreement(node, parse_json(values_text(ours)), theirs)


def _scenario(content: Mapping[str, Any]) -> Scenario:
    try:
        return scenario_from_mapping(content)
    except DdctError:
        raise
    except (TypeError, ValueError) as error:
        raise DdctError(f'its scenario cannot be used ({error})', key='scenario') from error


def _patch(known: Mapping[str, Any], true: Mapping[str, Any]) -> dict[str, Any]:
    """Return the merge patch that makes the true content out of the known one."""
    patch: dict[str, Any] = {key: None for key in known if key not in true}
    for key, value in true.items():
        before = known.get(key)
        if isinstance(before, Mapping) and isinstance(value, Mapping):
            if changed := _patch(before, value):
                patch[key] = changed
        elif before != value:
            patch[key] = value
    return patch


def _merged(known: Mapping[str, Any], patch: Mapping[str, Any]) -> dict[str, Any]:
    """Return the known content with the values of a merge patch."""
    content = {key: value for key, value in known.items() if key not in patch}
    for key, value in patch.items():
        before = known.get(key)
        if isinstance(value, Mapping) and isinstance(before, Mapping):
            content[key] = _merged(before, value)
        elif value is not None:
            content[key] = value
    return content
