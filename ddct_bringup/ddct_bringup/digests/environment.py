# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Environment of a result: version and digest of the code, other packages, kind of processor."""

import platform
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.metadata import PackageNotFoundError, version

from ddct_bringup.digests.code import code_digest
from ddct_bringup.digests.processor import this_processor
from ddct_plant.program.command_line import package_version

_PACKAGES = ('numpy', 'scipy', 'daqp', 'osqp', 'slycot', 'pyarrow')
"""Packages that compute numbers of runs, or write their files."""

_LONG = ('features',)
"""Keys whose values are too long for a message."""


@dataclass(frozen=True)
class Environment:
    """Conditions that decide the last bits of a run besides its settings."""

    version: str
    """Version of this project's packages."""
    code: str
    """SHA-256 of their sources."""
    packages: Mapping[str, str]
    """Versions of Python and of other packages, by name."""
    processor: Mapping[str, str] | None
    """Kind of processor, from `this_processor`; None where several took part."""

    def differences(self, other: 'Environment') -> list[str]:
        """Return the differences of another environment from this one as text, none if equal."""
        found = _differences({'version': self.version}, {'version': other.version})
        if self.code != other.code:
            found.append(f'code {self.code[:10]}, here {other.code[:10]}')
        found += _differences(self.packages, other.packages)
        if self.processor is None or other.processor is None:
            return [*found, 'kinds of processor that are not known']
        return found + _differences(self.processor, other.processor)


def this_environment() -> Environment:
    """Return the environment of this process."""
    return Environment(package_version(), code_digest(), _packages(), this_processor())


@cache
def _packages() -> Mapping[str, str]:
    packages = {'python': platform.python_version()}
    for name in _PACKAGES:
        try:
            packages[name] = version(name)
        except PackageNotFoundError:
            continue
    return packages


def _differences(ours: Mapping[str, str], theirs: Mapping[str, str]) -> list[str]:
    return [
        f'other {key}'
        if key in _LONG
        else f'{key} {ours.get(key, "none")}, here {theirs.get(key, "none")}'
        for key in (*ours, *(key for key in theirs if key not in ours))
        if ours.get(key) != theirs.get(key)
    ]
