# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`ddct check --new` writes a package that installs, is found, runs and passes its own tests."""

import importlib
import sys
import tomllib
from pathlib import Path

import pytest
from support.complaints import assert_one_line
from support.third_party import GROUP, install

from ddct_controllers.check import program as check
from ddct_controllers.template import package
from ddct_controllers.template.package import install_command


def write(folder: Path, name: str = 'my_slip') -> None:
    assert check.main(['--new', name, '--out', str(folder)]) == 0


def test_the_package_is_found_and_its_own_tests_pass(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """As if installed; with the printed commands it is installed in a nightly test."""
    folder = tmp_path / 'my own slip'
    write(folder)
    project = tomllib.loads((folder / 'pyproject.toml').read_text(encoding='utf-8'))['project']
    install(monkeypatch, tmp_path / 'site', folder / 'src', project['entry-points'][GROUP])
    monkeypatch.syspath_prepend(folder)
    try:
        tests = importlib.import_module('test_my_slip')
        functions = [value for name, value in vars(tests).items() if name.startswith('test_')]
        assert len(functions) == 3
        for function in functions:
            function()
    finally:
        for module in ('my_slip', 'test_my_slip'):
            sys.modules.pop(module, None)


@pytest.mark.parametrize(
    ('pip', 'program'),
    [(True, f'{sys.executable} -m pip install '), (False, 'uv pip install --python ')],
)
def test_the_printed_command_uses_what_an_environment_without_uv_has(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, pip: bool, program: str
) -> None:
    monkeypatch.setattr(sys, 'prefix', str(tmp_path))
    monkeypatch.setattr(package, 'find_spec', lambda name: object() if pip else None)
    command = install_command('DIR')
    assert command.startswith(program)
    assert command.endswith(' --no-build-isolation -e DIR')


def test_the_printed_next_steps_are_those_of_the_readme(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    write(tmp_path / 'other', 'other')
    *_, install, tried, compare = capfd.readouterr().out.splitlines()
    readme = (tmp_path / 'other' / 'README.md').read_text(encoding='utf-8')
    assert '\n'.join(f'  {line}' for line in (install, tried, compare)) in readme
    assert tried.strip() == 'ddct check other'
    assert f'-m pytest {tmp_path / "other"}`' in readme


def test_the_entry_point_leads_to_the_class(tmp_path: Path) -> None:
    write(tmp_path / 'x', 'gain_2_high')
    project = tomllib.loads((tmp_path / 'x' / 'pyproject.toml').read_text(encoding='utf-8'))
    points = project['project']['entry-points']['ddct.controllers']
    assert points == {'gain_2_high': 'gain_2_high:Gain2High'}
    code = (tmp_path / 'x' / 'src' / 'gain_2_high.py').read_text(encoding='utf-8')
    assert 'class Gain2High(Controller):' in code


@pytest.mark.parametrize(
    ('name', 'words'),
    [
        ('pi', 'pi is the name of another controller'),
        ('numpy', 'numpy is a module or word of Python already'),
        ('class', 'class is a module or word of Python already'),
        ('My-Slip', "controller name 'My-Slip': use up to 40 lower-case letters"),
        ('../up', "controller name '../up'"),
    ],
)
def test_a_name_that_cannot_be_used_is_refused(
    capfd: pytest.CaptureFixture[str], tmp_path: Path, name: str, words: str
) -> None:
    assert check.main(['--new', name, '--out', str(tmp_path / 'new')]) == 1
    assert_one_line(capfd.readouterr().err, 'ddct check', words)
    assert not (tmp_path / 'new').exists()


@pytest.mark.parametrize('option', [('--json', '-'), ('--set', 'clutch=stick_slip')])
def test_options_of_a_check_are_refused_for_a_new_package(
    capfd: pytest.CaptureFixture[str], tmp_path: Path, option: tuple[str, str]
) -> None:
    assert check.main(['--new', 'mine', '--out', str(tmp_path / 'new'), *option]) == 1
    assert_one_line(capfd.readouterr().err, 'ddct check', 'leave all options but --out out')
    assert not (tmp_path / 'new').exists()


def test_a_folder_that_is_there_stays_as_it_is(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert check.main(['--new', 'no_module_yet', '--out', str(tmp_path)]) == 1
    assert_one_line(capfd.readouterr().err, 'ddct check', f'{tmp_path} exists already')
    assert list(tmp_path.iterdir()) == []
