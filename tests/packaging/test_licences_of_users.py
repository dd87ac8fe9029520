# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What users install has no package under the GPL, and the product runs without the tests'."""

import re
import subprocess
import sys
from collections.abc import Iterator
from email.message import Message
from importlib.metadata import PackageMetadata, PackageNotFoundError, distribution, metadata
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
USERS = ('workspace', 'uv', 'fmu', 'gym', 'tune')
"""Locks that `make setup` installs, the last three on request."""
TESTS = 'test'
NOT_IN_THE_WHEEL = {'docutils': 'rst.el'}
"""By package under another licence the one file of it under the GPL, which its wheel lacks."""
_GPL = re.compile(r'(?<!L)(?<!Lesser )(?<!Library or Lesser )(GPL|General Public Licen[sc]e)')


def locked(name: str) -> list[str]:
    """Return the names of the packages in a lock."""
    text = (ROOT / 'locks' / f'{name}.txt').read_text(encoding='utf-8')
    return re.findall(r'^([\w.-]+)==', text, re.MULTILINE)


def is_gpl(about: PackageMetadata) -> bool:
    """Return whether a package states the GPL, and no other licence that may be chosen."""
    # Not about[key]: a newer importlib.metadata, which another library may bring, raises KeyError.
    stated = [
        each for key in ('License', 'License-Expression') for each in about.get_all(key) or ()
    ]
    stated += [each for each in about.get_all('Classifier') or () if each.startswith('License')]
    # A text of a whole licence names others in its first lines at most.
    return any(_GPL.search(each[:200]) and ' OR ' not in each for each in stated)


def gpl_packages(lock: str) -> Iterator[str]:
    for name in locked(lock):
        try:
            about = metadata(name)
        except PackageNotFoundError:  # of another Python or system
            continue
        files = {each.name for each in distribution(name).files or ()}
        if is_gpl(about) and NOT_IN_THE_WHEEL.get(name, '') in {'', *files}:
            yield name


def test_no_package_of_the_users_is_under_the_gpl() -> None:
    assert len(locked(USERS[0])) > 100
    assert [(lock, name) for lock in USERS for name in gpl_packages(lock)] == []


def test_the_package_under_the_gpl_is_in_the_lock_of_the_tests_alone() -> None:
    assert 'slycot' in locked(TESTS)
    assert set(gpl_packages(TESTS)) <= {'slycot'}
    assert all('slycot' not in locked(lock) for lock in USERS)


def test_the_gpl_is_found_and_the_lgpl_is_not() -> None:
    def of(**fields: str) -> PackageMetadata:
        about = Message()
        for key, value in fields.items():
            about[key.replace('_', '-')] = value
        return about  # type: ignore[return-value]

    assert is_gpl(of(License='GPL-2.0'))
    assert is_gpl(of(License_Expression='GPL-3.0-or-later'))
    assert is_gpl(
        of(Classifier='License :: OSI Approved :: GNU General Public License v2 (GPLv2)')
    )
    assert not is_gpl(of(License='LGPL-2.1'))
    assert not is_gpl(of(License_Expression='MPL-2.0 OR GPL-2.0'))
    lesser = 'License :: OSI Approved :: GNU Lesser General Public License v3 (LGPLv3)'
    assert not is_gpl(of(Classifier=lesser))


@pytest.mark.nightly
@pytest.mark.process
def test_the_product_runs_and_designs_without_it() -> None:
    """python-control takes slycot wherever it is installed, so it is hidden here."""
    code = (
        'import sys\n'
        "sys.modules['slycot'] = None\n"
        'from ddct_bringup.programs.bringup import main\n'
        'from ddct_controllers.design.h_infinity import design\n'
        "assert main(['--list']) == 0\n"
    )
    done = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_no_module_of_the_product_imports_it() -> None:
    found = [
        str(file)
        for package in ROOT.glob('ddct_*')
        for file in (package / package.name).rglob('*.py')
        if re.search(r'(import|from) slycot', file.read_text(encoding='utf-8'))
    ]
    assert found == []
