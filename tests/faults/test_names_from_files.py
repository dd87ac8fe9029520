# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A name in a file becomes no path, command or markup: it is refused where it could."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from refusals import refused
from support.complaints import assert_one_line
from support.processes import Programs

from ddct_bringup.bag.run_facts import RunConditions
from ddct_bringup.benchmark.manifest import BenchmarkManifest, JudgedEntry
from ddct_bringup.digests.digest_file import Digests, read_digests
from ddct_bringup.digests.environment import this_environment
from ddct_bringup.programs import bringup, compare
from ddct_bringup.tuning.manifest import TuningManifest
from ddct_bringup.verdict.limits import packaged_limits
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
    RunConditions(name, 'base', 'thesis', 'linear', 1.0, 'lockstep', 0)


def bag_with_scenario(name: str, _: Path) -> None:
    RunConditions('pi', 'base', name, 'linear', 1.0, 'lockstep', 0)


def judged(name: str, _: Path) -> None:
    JudgedEntry(name, 'pi', {}, 0)


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
def test_a_benchmark_names_no_controller_file_elsewhere(chosen: str, tmp_path: Path) -> None:
    with refused(ParameterError, 'controllers.chosen'):
        JudgedEntry('mine', chosen, {}, 0)
    manifest = {'schema_version': 1, 'controllers': [{'name': 'mine', 'chosen': chosen}]}
    (tmp_path / 'benchmark.json').write_text(json.dumps(manifest))
    with pytest.raises(DdctError):
        BenchmarkManifest.read(tmp_path)


@pytest.mark.parametrize(
    ('key', 'value'),
    [('name', '../escaped'), ('chosen', '../mine.py'), ('chosen', '/tmp/mine.py')],
)
def test_a_tuning_names_no_controller_file_elsewhere(key: str, value: str, tmp_path: Path) -> None:
    controller = {'name': 'mine', 'chosen': 'pi', 'folder': str(tmp_path), 'digests': {}}
    manifest = TuningManifest(1, '', '', '', {}, {**controller, key: value}, '', {}, '')
    with refused(ParameterError, f'controllers.{key}'):
        manifest.tuning(packaged_limits())


@pytest.mark.parametrize('path', ['../outside', '/etc/hostname', 'a/../../b'])
def test_digests_name_no_file_outside_of_their_folder(path: str, tmp_path: Path) -> None:
    Digests(1, 'runs', {path: 64 * '0'}, this_environment()).write(tmp_path)
    with pytest.raises(DdctError, match='outside of the folder'):
        read_digests(tmp_path)
