# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The sdist and the wheel of each package, and what both must hold."""

import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from collections.abc import Sequence
from email.parser import Parser
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
"""The packages, each after those that it needs."""
IGNORED = shutil.ignore_patterns('test', '__pycache__', '*.egg-info', 'build', 'dist')

DESCRIPTION = """
[metadata]
long_description=file: README.md
long_description_content_type=text/markdown
"""
"""Settings of a release alone: colcon builds where there is no README.md."""

PLACEHOLDER = 'maintainers@ddct.invalid'
"""Address in the package.xml of the sources: REP 149 asks for one, and the project has none."""
_ADDRESS = re.compile(r'[\w.%+-]+@([\w-]+\.)+[A-Za-z]{2,}')
_RESERVED = re.compile(r'[@.](invalid|example|test|localhost|example\.(com|org|net))$')
"""Ends of addresses that reach nobody, RFC 2606."""


class ReleaseError(Exception):
    """A file of the release, or a program that uses it, is not as it must be."""


def run(*command: str | Path, cwd: Path | None = None) -> str:
    """Return the output of a command; raise ReleaseError with all of it if it fails."""
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False)
    if done.returncode:
        shown = ' '.join(map(str, command))
        raise ReleaseError(f'{shown} ended with {done.returncode}:\n{done.stdout}{done.stderr}')
    return done.stdout


def require_address(address: str) -> None:
    """Raise ReleaseError for what is no address, or one of those that reach nobody."""
    if not _ADDRESS.fullmatch(address) or _RESERVED.search(address):
        raise ReleaseError(f'--maintainer {address} reaches nobody: give name@domain')


def built(folder: Path, maintainer: str = '') -> list[Path]:
    """
    Build all packages into a folder; return their wheels, in the order of `PACKAGES`.

    Each package is built from a copy, so that nothing of an earlier build gets into it. The wheel
    is built out of the sdist. Both have the address of the `maintainer` in their package.xml, or
    the placeholder of the sources. Raise ReleaseError for a wheel or sdist that lacks a file.
    """
    uv, wheels = Path(sys.executable).with_name('uv'), []
    for package in PACKAGES:
        source = folder.parent / 'sources' / package
        shutil.copytree(ROOT / package, source, ignore=IGNORED)
        with (source / 'setup.cfg').open('a', encoding='utf-8') as settings:
            settings.write(DESCRIPTION)
        if maintainer:
            name_maintainer(source / 'package.xml', maintainer)
        run(uv, 'build', '--quiet', '--no-build-isolation', '--out-dir', folder, source)
        (wheel,) = folder.glob(f'{package}-*.whl')
        (sdist,) = folder.glob(f'{package}-*.tar.gz')
        require_content(wheel.name, zipfile.ZipFile(wheel).namelist(), package)
        with tarfile.open(sdist) as archive:
            require_content(sdist.name, archive.getnames(), package)
        with zipfile.ZipFile(wheel) as archive:
            (name,) = (each for each in archive.namelist() if each.endswith('/METADATA'))
            require_metadata(wheel.name, archive.read(name).decode())
        wheels.append(wheel)
    return wheels


def name_maintainer(file: Path, address: str) -> None:
    """Write an address into a package.xml; raise ReleaseError where the placeholder is not."""
    text = file.read_text(encoding='utf-8')
    if PLACEHOLDER not in text:
        raise ReleaseError(
            f'{file.parent.name}/package.xml has an address: leave --maintainer out'
        )
    lines = [line for line in text.splitlines(keepends=True) if 'REP 149 asks' not in line]
    file.write_text(''.join(lines).replace(PLACEHOLDER, address), encoding='utf-8')


def require_content(file: str, names: Sequence[str], package: str) -> None:
    """Raise ReleaseError unless an archive of a package holds types and licence, and no tests."""
    for wanted in (f'{package}/py.typed', 'LICENSE', 'package.xml'):
        if not any(name.endswith(wanted) for name in names):
            raise ReleaseError(f'{file} has no {wanted}')
    if tests := [name for name in names if '/test/' in name]:
        raise ReleaseError(f'{file} holds tests: {tests[0]}')


def require_metadata(file: str, text: str) -> None:
    """Raise ReleaseError unless metadata are complete, without an address that does not exist."""
    metadata = Parser().parsestr(text)
    for key in ('Summary', 'License', 'Requires-Python', 'Description-Content-Type'):
        if not metadata[key]:
            raise ReleaseError(f'{file} has no {key} in its metadata')
    if any('.invalid' in value for value in metadata.values()):
        raise ReleaseError(f'{file} names an address that does not exist')
