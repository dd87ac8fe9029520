# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Kind of processor: the code that linear algebra and numpy choose for it when they are loaded.

OpenBLAS picks its kernels by processor, or by the variable OPENBLAS_CORETYPE. Different kernels
round differently, so that the last bits of a run depend on them.
"""

import ctypes
import platform
from functools import cache
from pathlib import Path

import numpy as np

KERNELS = (
    'scipy_openblas_get_corename64_',
    'scipy_openblas_get_corename',
    'openblas_get_corename64_',
    'openblas_get_corename',
)
"""Functions of OpenBLAS that return the name of its kernels, by the builds of its packages."""
_BUNDLES = {'numpy.libs': 'numpy', 'scipy.libs': 'scipy'}
"""Packages by the folder of the libraries in their wheels."""
_FOREIGN = '.libs'
"""Ending of the folder of the libraries of another wheel, which no run uses."""
SYSTEM = 'system'


@cache
def this_processor() -> dict[str, str]:
    """
    Return the kind of this processor as text by key.

    `machine` is its architecture, `features` are those of its instruction sets that numpy uses,
    `libc` is the C library, which has functions such as the exponential for each processor.
    `kernels of numpy` and `kernels of scipy`, or `kernels of system` for one OpenBLAS of the
    system, are the names of OpenBLAS's kernels; they are absent for another library.
    """
    return {
        'machine': platform.machine(),
        'features': ' '.join(_features()),
        'libc': ' '.join(platform.libc_ver()),
        **{f'kernels of {package}': name for package, name in sorted(_kernels().items())},
    }


def _features() -> list[str]:
    core = getattr(np, '_core', None)
    found = getattr(getattr(core, '_multiarray_umath', None), '__cpu_features__', {})
    return sorted(name for name, there in found.items() if there)


def _kernels() -> dict[str, str]:
    """Return the names of the kernels that are in use, by package."""
    # Only here: it loads the OpenBLAS of scipy, which takes some tenths of a second.
    import scipy.linalg  # noqa: F401

    found = {}
    for path in sorted(loaded_libraries()):
        package = _BUNDLES.get(path.parent.name, SYSTEM)
        if package == SYSTEM and path.parent.name.endswith(_FOREIGN):
            continue
        library = ctypes.CDLL(str(path))
        for function in KERNELS:
            if hasattr(library, function):
                name = getattr(library, function)
                name.restype = ctypes.c_char_p
                found[package] = (name() or b'unknown').decode()
                break
    return found


def loaded_libraries() -> set[Path]:
    """Return the paths of the OpenBLAS libraries that this process has loaded."""
    words = Path('/proc/self/maps').read_text(encoding='utf-8').split()
    return {Path(word) for word in words if '/' in word and 'openblas' in Path(word).name}
