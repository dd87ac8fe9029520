# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The keys for which the code opens a file are these and no others."""

import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import fields, replace
from functools import cache, partial
from itertools import product
from pathlib import Path
from typing import Any

import pytest

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.keys import FILE_KEY, run_options, sections
from ddct_bringup.campaign.spec import _KEYS as CAMPAIGN_KEYS
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.campaign.specification.named_files import digest_of
from ddct_bringup.manifest.inputs import INPUTS, InputFiles
from ddct_bringup.manifest.runs import PlannedRun
from ddct_bringup.run.plan import RunPlan
from ddct_controllers.from_file.kinds import KINDS
from ddct_controllers.from_file.with_options import KIND as WITH_OPTIONS
from ddct_controllers.registry import controller_spec
from ddct_plant.base.errors import DdctError
from ddct_plant.files.yaml_text import dump_yaml
from ddct_plant.scenario.choices.scenarios import CHOICES
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.key_names import scenario_options
from ddct_plant.scenario.settings import KnownSettings, RunSettings

NAMED = 'named_by_a_key'
FILES = (f'{NAMED}.py', f'{NAMED}.yaml', f'{NAMED}.csv')
PROFILE = {'csv': FILES[2], 'time': 't', 'value': 'c', 'unit': 'N m'}
CAMPAIGN: dict[str, Any] = {
    'controllers': ['pi'],
    'scenario': 'upshift',
    'grid': {'wear_gain': [1.0]},
}
CONTROLLERS = {
    **dict.fromkeys(KINDS, {}),
    'c_library': {'file': '-', 'parameters': {}},
    'fmu': {'file': '-', 'inputs': {}, 'outputs': {}, 'parameters': {}},
    WITH_OPTIONS: {'controller': '-', 'options': {}},
}
"""Keys of each kind of controller file; those of linear controllers are numbers."""
OF_CAMPAIGN = {'car', 'controllers', 'csv', 'drive', 'handover', 'scenario'}
OF_SCENARIO = {'base', 'car', 'csv', 'drive'}
OF_CONTROLLER = {'c_library.file', 'fmu.file', 'with_options.controller'}
OF_RUN = {'controller', 'settings.handover'}
"""Keys that name files, which docs/use/live.md lists too."""
SHIFT = RunSettings(KnownSettings(load_scenario('upshift')))


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """Return a folder with the files that keys may name."""
    for name in FILES:
        (tmp_path / name).write_text('{}\n', encoding='utf-8')
    return tmp_path


class _Opened:
    """Whether a file of that name is opened, of which Python informs a hook that stays."""

    seen = False

    def hook(self, event: str, arguments: tuple[Any, ...]) -> None:
        if event == 'open' and NAMED in str(arguments[0]):
            self.seen = True


@cache
def _opened() -> _Opened:
    opened = _Opened()
    sys.addaudithook(opened.hook)
    return opened


def opens(use: Callable[[], object]) -> bool:
    """Return whether a use opens one of the files."""
    opened = _opened()
    opened.seen = False
    with suppress(DdctError):
        use()
    return opened.seen


def planned(place: Path, content: dict[str, Any]) -> RunPlan:
    """Return the plan of the first run of a campaign, which has made its parts."""
    made = Campaign(spec_of(content, place))
    return RunPlan(made.run(0).settings, made.chosen(0), 'headless')


def digested(place: Path, content: dict[str, Any]) -> str:
    """Return the digest of a campaign and of its files."""
    return digest_of(spec_of(content, place))


def _with(known: PlannedRun, name: str, value: Any) -> PlannedRun:
    return replace(known, **{name: value})


def made_from(planned_run: PlannedRun, place: Path) -> None:
    """Make the plan of a run; a value of another type could not be in a manifest."""
    with suppress(TypeError, AttributeError, ValueError):
        planned_run.headless_plan(place)


def contents() -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield each key of a campaign with contents in which it might name a file."""
    for key in CAMPAIGN_KEYS:
        for file in FILES:
            yield key, {**CAMPAIGN, key: file}
            yield key, {**CAMPAIGN, key: [file]}
    options = controller_spec('pi').options or {}
    grid = (
        *CHOICES,
        *run_options(),
        *scenario_options(),
        *sections(),
        *(f'{section}{FILE_KEY}' for section in sections()),
        *(f'controllers.pi.{name}' for name in options),
    )
    for key in grid:
        varied = {name: CAMPAIGN[name] for name in CAMPAIGN if name != key}
        for value in (*FILES, PROFILE):
            name = 'csv' if key.endswith(FILE_KEY) or value is PROFILE else key
            yield name, {**varied, 'grid': {key: [value]}}


@pytest.mark.nightly
def test_those_of_a_campaign_and_each_such_file_is_in_its_digest(place: Path) -> None:
    found, in_digest = set(), set()
    for key, content in contents():
        if opens(partial(planned, place, content)):
            found.add(key)
            if opens(partial(digested, place, content)):
                in_digest.add(key)
    assert found == in_digest == OF_CAMPAIGN


@pytest.mark.nightly
def test_those_of_a_scenario_a_car_and_a_drive(place: Path) -> None:
    found = set()
    bases = {'scenario': {'car': 'c635', 'drive': 'launch'}, 'car': {}, 'drive': {}}
    for key in ('car', 'drive', 'base', 'set', *scenario_options(), *sections()):
        for noun, value in product(bases, (*FILES, PROFILE)):
            section, _, rest = key.partition('.')
            content = {**bases[noun], section: {rest: value} if rest else value}
            (place / 'own.yaml').write_text(dump_yaml(content), encoding='utf-8')
            chosen = {noun: str(place / 'own.yaml')}
            if noun == 'car':
                chosen['drive'] = 'launch'
            if opens(partial(load_scenario, **chosen)):
                found.add('csv' if value is PROFILE else key)
    assert found == OF_SCENARIO


def test_those_of_a_controller_file(place: Path) -> None:
    found = set()
    assert CONTROLLERS.keys() == {*KINDS, WITH_OPTIONS}, 'give the keys of the new kind'
    for kind, keys in CONTROLLERS.items():
        for key in keys:
            for file in FILES:
                content = {'name': 'mine', kind: {**keys, key: file}}
                path = place / 'mine.yaml'
                path.write_text(dump_yaml(content), encoding='utf-8')
                if opens(partial(controller_spec, str(path))):
                    found.add(f'{kind}.{key}')
    assert found == OF_CONTROLLER


def test_those_of_the_plan_of_a_run(place: Path) -> None:
    shutil.copytree(place, place / INPUTS)
    known = PlannedRun.of(RunPlan(SHIFT, 'pi', 'headless'), InputFiles())
    found = set()
    for file in FILES:
        changed = {
            **{
                each.name: _with(known, each.name, file)
                for each in fields(PlannedRun)
                if each.name != 'layout'  # one of three words
            },
            **{
                f'settings.{name}': replace(known, settings={**known.settings, name: file})
                for name in known.settings
            },
        }
        found |= {name for name, plan in changed.items() if opens(partial(made_from, plan, place))}
    assert found == OF_RUN
