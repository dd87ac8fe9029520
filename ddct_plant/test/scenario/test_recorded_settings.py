# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Settings of a run are written as one JSON of two parts, and come back to the last bit."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from refusals import refused

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.json_records import to_json, write_json
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.recorded_settings import (
    CasePart,
    KnownPart,
    RecordedSettings,
    _merged,
    _patch,
    known_settings,
    known_values,
    read_part,
    require_agreement,
    require_same,
    run_settings,
    settings_of_bag,
    values_of,
    values_text,
)
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

THESIS, LAUNCH = load_scenario('thesis'), load_scenario('launch')
TRUE = {'vehicle.mass_kg': 1789.25, 'actuator.delay_s': 0.013, 'load.slope_rad': 0.1 / 3.0}
PLAIN = RunSettings(KnownSettings(THESIS, architecture='base', mode='realtime'))
VARIED = RunSettings(
    KnownSettings(LAUNCH),
    CaseSettings(
        wear_gain=math.nextafter(0.7, 1.0), seed=424243, scenario=load_scenario('launch', TRUE)
    ),
)
SHIFT = RunSettings(
    KnownSettings(load_scenario('upshift'), handover='slip'),
    CaseSettings(off_going_wear_gain=0.9, scenario=load_scenario('upshift', TRUE)),
)
ALL = pytest.mark.parametrize('of', [PLAIN, VARIED, SHIFT], ids=['plain', 'varied', 'shift'])


def recorded(of: RunSettings) -> RecordedSettings:
    return RecordedSettings.of(of, 'pi', 0.7)


@ALL
def test_settings_come_back_from_a_bag_to_the_last_bit(of: RunSettings) -> None:
    found = settings_of_bag({'settings': recorded(of).text()})
    assert found == recorded(of)
    assert run_settings(found.known, found.case) == of
    assert (found.known.controller, found.known.steps) == ('pi', 70)


@ALL
def test_the_known_part_makes_the_known_settings(of: RunSettings) -> None:
    assert known_settings(recorded(of).known) == of.known


@ALL
def test_each_part_has_a_file_of_its_own(tmp_path: Path, of: RunSettings) -> None:
    known, case = recorded(of).parts
    files = [str(tmp_path / name) for name in ('KnownPart.json', 'CasePart.json')]
    for file, part in zip(files, (known, case), strict=True):
        write_json(file, part)
    assert read_part(KnownPart, files[0]) == known
    assert read_part(CasePart, files[1]) == case
    with refused(ParameterError, 'known', place='KnownPart.json'):
        read_part(CasePart, str(tmp_path / 'KnownPart.json'))


def test_no_value_of_the_case_is_in_the_known_part() -> None:
    record = recorded(VARIED)
    text = json.dumps(to_json(record.known))
    for value in (VARIED.case.wear_gain, VARIED.case.seed, *TRUE.values()):
        assert repr(value) not in text
    assert set(record.case.scenario) == {'vehicle', 'driveline', 'actuator', 'load'}
    assert record.case.scenario['vehicle'] == {'mass_kg': 1789.25}


def test_a_case_without_other_values_of_the_scenario_has_none() -> None:
    worn = RunSettings(PLAIN.known, CaseSettings(wear_gain=0.8))
    assert recorded(worn).case.scenario == {}
    assert recorded(worn).case.off_going_wear_gain is None
    assert recorded(worn).known.handover is None
    assert recorded(worn).known == recorded(PLAIN).known
    assert recorded(SHIFT).known.handover == 'slip'
    assert recorded(SHIFT).case.off_going_wear_gain == 0.9


VALUES = st.recursive(
    st.integers(0, 3) | st.lists(st.integers(0, 1), max_size=2),
    lambda inner: st.dictionaries(st.sampled_from('abc'), inner, max_size=3),
    max_leaves=6,
)
CONTENTS = st.dictionaries(st.sampled_from('abc'), VALUES, max_size=3)


@pytest.mark.slow
@settings(max_examples=40)
@given(known=CONTENTS, true=CONTENTS)
def test_a_patch_makes_the_true_content_of_the_known_one(known: Any, true: Any) -> None:
    patch = _patch(known, true)
    assert _merged(known, patch) == true
    assert (patch == {}) == (known == true)


def test_a_difference_is_named_with_both_values() -> None:
    others = RunSettings(VARIED.known, replace(VARIED.case, seed=7))
    with refused(ParameterError, 'seed') as caught:
        require_same('/clutch', values_of(VARIED), values_text(values_of(others)))
    assert str(caught.value) == (
        'node /clutch has seed 424243, but the settings of the run have 7: '
        'start every node with the same settings'
    )
    require_same('/clutch', values_of(VARIED), values_text(values_of(VARIED)))


def test_a_key_that_only_one_has_is_a_difference() -> None:
    for ours, theirs in (({'a': 1}, {}), ({}, {'a': 1})):
        with refused(ParameterError, 'a') as caught:
            require_agreement('/load', ours, theirs)
        assert 'left out' in str(caught.value)


def test_known_values_of_runs_with_other_cases_are_the_same_and_others_differ() -> None:
    plain = RunSettings(KnownSettings(LAUNCH))
    assert known_values(VARIED.known) == known_values(plain.known)
    assert not {'wear_gain', 'seed', 'off_going_wear_gain'} & known_values(VARIED.known).keys()
    assert values_of(VARIED) != values_of(plain)
    hill = replace(plain.known, scenario=load_scenario('launch', {'load.slope_rad': 0.1}))
    with refused(ParameterError, 'scenario.load.slope_rad'):
        require_agreement('/load', known_values(hill), known_values(plain.known))
    with refused(ParameterError, 'handover'):
        require_agreement(
            '/handover',
            known_values(SHIFT.known),
            known_values(replace(SHIFT.known, handover='timed')),
        )


def test_remarks_and_descriptions_are_no_difference() -> None:
    named = replace(THESIS, description='another', adjusted=('moved',))
    assert values_of(RunSettings(KnownSettings(named))) == values_of(
        RunSettings(KnownSettings(THESIS))
    )


def test_a_handover_in_a_file_has_its_name_in_the_settings() -> None:
    known = replace(SHIFT.known, handover='/home/somebody/mine.py')
    in_a_file = RunSettings(known, SHIFT.case)
    assert recorded(in_a_file).known.handover == 'mine'
    assert values_of(in_a_file)['handover'] == 'mine'


@pytest.mark.parametrize('name', ['controller', 'architecture', 'mode', 'handover'])
def test_a_name_that_no_file_could_have_is_refused(name: str) -> None:
    change: Any = {name: '../evil'}
    with refused(ParameterError, name):
        replace(recorded(SHIFT).known, **change)


@pytest.mark.parametrize('duration_s', [0.0, 0.009, 3600.01])
def test_a_duration_that_no_run_has_is_refused(duration_s: float) -> None:
    with refused(ParameterError, 'duration_s'):
        replace(recorded(PLAIN).known, duration_s=duration_s)
    assert replace(recorded(PLAIN).known, duration_s=3600.0).steps == 360000


@pytest.mark.parametrize('content', [{'engine': 5}, {'name': 'x', 'gear': 'two'}])
def test_a_scenario_that_cannot_be_built_is_one_line(content: dict[str, Any]) -> None:
    known = recorded(PLAIN).known
    with pytest.raises(DdctError) as caught:
        known_settings(replace(known, scenario={**known.scenario, **content}))
    assert '\n' not in str(caught.value)
