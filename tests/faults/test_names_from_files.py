# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A name in a file becomes no path, command or markup: it is refused where it could."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from refusals import refused
from support.complaints import assert_one_line
from support.processes import Programs

from ddct_bringup.bag.run_facts import RunConditions
from ddct_bringup.benchmark.plan import JudgedEntry
from ddct_bringup.manifest.inputs import InputFiles
from ddct_bringup.manifest.manifest import RUNS, begin_manifest, read_manifest
from ddct_bringup.programs import bringup, compare
from ddct_bringup.tuning.plan import TunedEntry
from ddct_controllers.registry import controller_spec
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.scenario.file import load_scenario, scenario_to_yaml

HOSTILE = [
    *('', '.', '..', '../up', 'a/b', '/tmp/absolute', '-rf', '$(touch x)', '`touch x`', '~'),
    *('<b>bold</b>', 'a b', 'a\nb', 'a\x1b[2J', 'a\u202eb', 'a\\b', 100 * 'x'),
]
"""Names that would be another folder, an option, a command or markup where they are used."""


def scenario_named(name: str, folder: Path) -> None:
    file = folder / 'mine.yaml'
    text = scenario_to_yaml(load_scenario('thesis'))
    assert '\nname: thesis\n' in f'\n{text}'
    file.write_text(text.replace('name: thesis\n', f'name: {json.dumps(name)}\n', 1))
    load_scenario(str(file))


def controller_named(name: str, folder: Path) -> None:
    file = folder / 'mine.yaml'
    (folder / 'mine.so').touch()
    file.write_text(f'name: {json.dumps(name)}\nc_library: {{file: mine.so}}\n')
    controller_spec(str(file))


def bag_of(name: str, _: Path) -> None:
    RunConditions(name, 'base', 'thesis', 1.0, 'lockstep', 0)


def bag_with_scenario(name: str, _: Path) -> None:
    RunConditions('pi', 'base', name, 1.0, 'lockstep', 0)


def judged(name: str, _: Path) -> None:
    JudgedEntry(name, 'pi', '.', {}, 0)


@pytest.mark.parametrize('name', HOSTILE)
@pytest.mark.parametrize(
    'use', [scenario_named, controller_named, bag_of, bag_with_scenario, judged]
)
def test_a_name_that_is_no_name_is_refused(
    use: Callable[[str, Path], None], name: str, tmp_path: Path
) -> None:
    use('mine', tmp_path)
    with pytest.raises(ParameterError) as raised:
        use(name, tmp_path)
    text = str(raised.value)
    assert text.isprintable()
    assert 'name' in text or 'controller' in text or 'scenario' in text
    assert {each.name for each in tmp_path.iterdir()} <= {'mine.yaml', 'mine.so'}


@pytest.mark.parametrize('program', [bringup, compare])
def test_a_hostile_name_leaves_nothing_outside_of_the_output(
    program: object, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    inner = tmp_path / 'inner'
    inner.mkdir()
    file = inner / 'mine.yaml'
    file.write_text('name: ../../escaped\nc_library: {file: mine.so}\n')
    (inner / 'mine.so').touch()
    option = '--controller' if program is bringup else '--controllers'
    arguments = [option, str(file), '--headless', '--out', str(inner / 'runs')]
    assert program.main(arguments) == 1  # type: ignore[attr-defined]
    assert_one_line(capfd.readouterr().err, program.PROGRAM, 'escaped')  # type: ignore[attr-defined]
    assert sorted(each.name for each in tmp_path.rglob('*')) == ['inner', 'mine.so', 'mine.yaml']


def test_the_recorder_writes_no_bag_elsewhere(programs: Programs, tmp_path: Path) -> None:
    out = tmp_path / 'out'
    recorder = 'ddct_bringup.record.recorder_node'
    node = programs.start_node(recorder, {'out': out, 'name': '../escaped'})
    assert node.wait() == 1
    assert_one_line(node.errors(), 'recorder', 'parameter name')
    assert not list(tmp_path.rglob('*escaped*'))


@pytest.mark.parametrize('chosen', ['../mine.py', '/tmp/mine.py', 'a/mine.yaml'])
def test_a_benchmark_names_no_controller_file_elsewhere(chosen: str) -> None:
    with refused(ParameterError, 'controllers.chosen'):
        JudgedEntry('mine', chosen, '.', {}, 0)


@pytest.mark.parametrize(
    ('key', 'value'),
    [('name', '../escaped'), ('chosen', '../mine.py'), ('chosen', '/tmp/mine.py')],
)
def test_a_tuning_names_no_controller_file_elsewhere(key: str, value: str) -> None:
    given: dict[str, Any] = {'name': 'mine', 'chosen': 'pi', 'folder': '.', 'digests': {}}
    with refused(ParameterError, f'controllers.{key}'):
        TunedEntry(**{**given, key: value})


@pytest.mark.parametrize('path', ['../outside', '/etc/hostname', 'a/../../b'])
def test_a_manifest_names_no_file_outside_of_its_result(path: str, tmp_path: Path) -> None:
    begin_manifest(tmp_path, RUNS, {}, InputFiles()).with_files({path: 64 * '0'}).write(tmp_path)
    with pytest.raises(DdctError, match='outside of the result'):
        read_manifest(tmp_path)
