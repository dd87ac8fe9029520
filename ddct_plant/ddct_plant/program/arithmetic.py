# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The arithmetic of a run: libraries, their kernel and threads, and versions decide its last bits.

OpenBLAS picks its kernel by processor when numpy or scipy loads it, and kernels round differently:
every process names one kernel and one thread before it imports numpy. Two runs with the same
settings and code have the same bits where `differences` finds nothing.
"""

import os
import sys
from collections.abc import Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from ddct_plant.program.operating_system import c_library, processor_features, processor_name

_KERNEL = 'OPENBLAS_CORETYPE'
"""Environment variable with the name of OpenBLAS's kernel."""
_THREADS = 'OPENBLAS_NUM_THREADS'
"""Environment variable with the number of OpenBLAS's threads."""
_HASWELL = 'Haswell'
"""Kernel for all processors of x86-64 with AVX2, of Intel since 2013 and of AMD since 2017."""
_NEEDED = {'avx2', 'fma'}
"""Features of a processor that this kernel uses, by their names in Linux."""

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


def choose_kernel() -> None:
    """
    Name kernel and threads in the environment of this process, unless they are named there.

    Processes that this one starts inherit them. Where numpy is loaded already, as in a notebook,
    its kernel is the one that is named: it stays, and those processes use it too.
    """
    # Matrices are small: more threads only wait for one another.
    os.environ.setdefault(_THREADS, '1')
    if _KERNEL not in os.environ:
        kernel = _kernel_of_numpy() if 'numpy' in sys.modules else _kernel_of_processor()
        if kernel:
            os.environ[_KERNEL] = kernel


def _kernel_of_processor() -> str | None:
    """Return the kernel that every process of this machine uses; None where OpenBLAS picks it."""
    return _HASWELL if processor_features() >= _NEEDED else None


def _kernel_of_numpy() -> str | None:
    return next((each.kernel for each in _blas_libraries() if each.kernel), None)


def named_threads() -> int:
    """Return the number of threads that the environment names, 1 where it names none."""
    named = os.environ.get(_THREADS, '')
    return max(1, int(named)) if named.isdecimal() else 1


def limit_threads(count: int) -> AbstractContextManager[Any]:
    """
    Let the loaded libraries use `count` threads from now on; as a context manager until its end.

    They may have been loaded before our package, with as many threads as the machine has cores.
    """
    from threadpoolctl import threadpool_limits

    limits: AbstractContextManager[Any] = threadpool_limits(count, user_api='blas')
    return limits


@dataclass(frozen=True)
class _Blas:
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
    import platform

    # Only here: it loads the OpenBLAS of scipy, which takes some tenths of a second.
    import scipy.linalg  # noqa: F401

    found = _blas_libraries()
    return Arithmetic(
        blas=_joined({each.user: each.name for each in found}),
        kernel=_joined({each.user: each.kernel for each in found}),
        threads=_joined({each.user: str(each.threads) for each in found}),
        libc=c_library(),
        versions={'python': platform.python_version(), **_versions()},
        machine=platform.machine(),
        processor=processor_name(),
    )


def _blas_libraries() -> list[_Blas]:
    """Return the libraries for linear algebra of numpy and scipy, as far as they are loaded."""
    from threadpoolctl import threadpool_info

    found = []
    for each in threadpool_info():
        folder = Path(each['filepath']).parent.name
        user = _WHEELS.get(folder, _SYSTEM)
        if each['user_api'] != 'blas' or (user == _SYSTEM and folder.endswith(_OTHER_WHEEL)):
            continue
        name = _NAMES.get(each['internal_api'], each['internal_api'])
        found.append(
            _Blas(
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
    from importlib.metadata import PackageNotFoundError, version

    found = {}
    for name in _PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found
