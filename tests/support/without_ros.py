# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Python in an environment with what the packages require of PyPI, and no more."""

import importlib.metadata
import os
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from waiting import WITHIN_S

from ddct_plant.program.command_line import package_version
from support.declared import PACKAGES, ROOT, declared_to_pip


def required(names: Iterable[str]) -> set[str]:
    """Return the distributions and what they require in turn, without extras."""
    found: set[str] = set()
    todo = list(names)
    while todo:
        name = todo.pop()
        if name not in found:
            found.add(name)
            needs = map(Requirement, importlib.metadata.requires(name) or ())
            todo += [n.name for n in needs if not n.marker or n.marker.evaluate({'extra': ''})]
    return found


def fill_site(folder: Path) -> Path:
    """Fill a folder with packages as pip would for the four of ours, and return it."""
    declared = {each for package in PACKAGES for each in declared_to_pip(package)[0]}
    for name in required({each for each in declared if not each.startswith(PACKAGES)}):
        distribution = importlib.metadata.distribution(name)
        if distribution.files is None:
            pytest.skip(f'{name} has no list of files: it was not installed by pip')
        for top in {file.parts[0] for file in distribution.files} - {'..', '__pycache__'}:
            link = folder / top
            if not link.exists():
                link.symlink_to(str(distribution.locate_file(top)))
    for package in PACKAGES:
        (folder / package).symlink_to(ROOT / package / package)
        metadata = folder / f'{package}-{package_version()}.dist-info'
        metadata.mkdir()
        text = f'Metadata-Version: 2.1\nName: {package}\nVersion: {package_version()}\n'
        (metadata / 'METADATA').write_text(text, encoding='utf-8')
    return folder


def python(site: Path, place: Path, *arguments: str) -> 'subprocess.CompletedProcess[str]':
    """Run Python where only the site's packages are installed."""
    environment = {
        key: value
        for key, value in os.environ.items()
        if not key.startswith(('AMENT', 'COLCON', 'ROS', '_ROS', 'PYTHON', 'LD_LIBRARY'))
    }
    return subprocess.run(
        [sys.executable, '-S', *arguments],
        cwd=place,
        env={**environment, 'PYTHONPATH': str(site)},
        capture_output=True,
        text=True,
        timeout=WITHIN_S,
        check=False,
    )
