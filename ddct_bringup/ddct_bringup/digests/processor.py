# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Kind of processor: the code that linear algebra and numpy choose for it when they are loaded.

OpenBLAS picks its kernels by processor, or by the variable OPENBLAS_CORETYPE. Different kernels
round differently, so that the last bits of a run depend on them.
"""

import platform
from functools import cache

import numpy as np

from ddct_plant.program.arithmetic import blas_libraries


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

    return {each.user: each.kernel for each in blas_libraries() if each.kernel}
