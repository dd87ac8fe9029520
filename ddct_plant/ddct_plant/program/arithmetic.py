# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The arithmetic of a run: libraries, their kernel, and versions, which decide its last bits.

Two runs with the same settings and code have the same bits where `differences` finds nothing.
"""

import platform
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from threadpoolctl import threadpool_info

_PACKAGES = (
    *('numpy', 'scipy', 'control', 'daqp', 'osqp', 'slycot', 'optuna'),
    *('mcap', 'zstandard', 'pyarrow'),
)
"""Packages that compute numbers of runs, and those that write their files."""
_NAMES = {'openblas': 'OpenBLAS', 'mkl': 'MKL', 'blis': 'BLIS'}
_WHEELS = {'numpy.libs': 'numpy', 'scipy.libs': 'scipy'}
"""Packages by the folder of the libraries in their wheels."""
_OTHER_WHEEL = '.libs'
"""End of the name of that folder in another wheel, whose library no run uses."""
_SYSTEM = 'system'


@dataclass(frozen=True)
class Blas:
    """A library for linear algebra that this process has loaded."""

    user: str
    """Package that brings it along: 'numpy' or 'scipy', or 'system' for that of the system."""
    name: str
    """Name and version."""
    kernel: str
    """Name of its code for this processor, '' where the library has no names."""
    threads: int


@dataclass(frozen=True)
class Arithmetic:
    """What decides the last bits of a run besides its settings and our code."""

    blas: str
    """Name and version of the library, with those of numpy and scipy where they differ."""
    kernel: str
    """Name of the library's code for this processor, likewise."""
    threads: str
    """Number of the library's threads, likewise."""
    libc: str
    """Name and version of the C library, which has the exponential and the like."""
    versions: Mapping[str, str]
    """Versions of Python and of the packages that compute or write results, by name."""
    machine: str
    """Architecture of the processor."""
    processor: str = field(compare=False)
    """Name of the processor: information, as the same kernel has the same bits on each."""

    def differences(self, other: 'Arithmetic') -> list[str]:
        """Return what differs in another one and may change bits, as text; none if nothing."""
        ours, theirs = self._deciding(), other._deciding()
        return [
            f'{key} {ours.get(key, "none")}, here {theirs.get(key, "none")}'
            for key in {**ours, **theirs}
            if ours.get(key) != theirs.get(key)
        ]

    def _deciding(self) -> dict[str, str]:
        return {
            'BLAS': self.blas,
            'kernel': self.kernel,
            'threads': self.threads,
            'C library': self.libc,
            'machine': self.machine,
            **self.versions,
        }


@cache
def arithmetic() -> Arithmetic:
    """Return the arithmetic of this process."""
    # Only here: it loads the OpenBLAS of scipy, which takes some tenths of a second.
    import scipy.linalg  # noqa: F401

    found = blas_libraries()
    return Arithmetic(
        blas=_joined({each.user: each.name for each in found}),
        kernel=_joined({each.user: each.kernel for each in found}),
        threads=_joined({each.user: str(each.threads) for each in found}),
        libc=' '.join(platform.libc_ver()),
        versions=_versions(),
        machine=platform.machine(),
        processor=_processor_name(),
    )


def blas_libraries() -> list[Blas]:
    """Return the libraries for linear algebra of numpy and scipy, as far as they are loaded."""
    found = []
    for each in threadpool_info():
        folder = Path(each['filepath']).parent.name
        user = _WHEELS.get(folder, _SYSTEM)
        if each['user_api'] != 'blas' or (user == _SYSTEM and folder.endswith(_OTHER_WHEEL)):
            continue
        name = _NAMES.get(each['internal_api'], each['internal_api'])
        found.append(
            Blas(
                user=user,
                name=f'{name} {each["version"] or "of unknown version"}',
                kernel=each.get('architecture') or '',
                threads=each['num_threads'],
            )
        )
    return sorted(found, key=lambda each: each.user)


def _joined(by_user: Mapping[str, str]) -> str:
    """Return the value that all users have, or each with its user."""
    values = {*by_user.values()}
    if len(values) > 1:
        return ', '.join(f'{value} ({user})' for user, value in by_user.items())
    return values.pop() if values else 'unknown'


def _versions() -> Mapping[str, str]:
    found = {'python': platform.python_version()}
    for name in _PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found


def _processor_name() -> str:
    with Path('/proc/cpuinfo').open(encoding='utf-8', errors='replace') as lines:
        names = (line.partition(':')[2] for line in lines if line.startswith('model name'))
        return next(names, platform.machine()).strip()
