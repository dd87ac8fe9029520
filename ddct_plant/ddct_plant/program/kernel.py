# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
One OpenBLAS kernel and one thread for every process, so that runs have the same bits everywhere.

OpenBLAS picks its kernel by processor when numpy or scipy loads it, and kernels round differently.
The package imports this module before it imports numpy.
"""

import os
import sys
from pathlib import Path

KERNEL = 'OPENBLAS_CORETYPE'
"""Environment variable with the name of OpenBLAS's kernel."""
THREADS = 'OPENBLAS_NUM_THREADS'
"""Environment variable with the number of OpenBLAS's threads."""
HASWELL = 'Haswell'
"""Kernel for all processors of x86-64 with AVX2, of Intel since 2013 and of AMD since 2017."""
_NEEDED = {'avx2', 'fma'}
"""Features of a processor that this kernel uses, by their names in Linux."""
_PROCESSOR = Path('/proc/cpuinfo')


def choose_kernel() -> None:
    """
    Name kernel and threads in the environment of this process, unless they are named there.

    Processes that this one starts inherit them. Where numpy is loaded already, as in a notebook,
    its kernel is the one that is named: it stays, and those processes use it too.
    """
    # Matrices are small: more threads only wait for one another.
    os.environ.setdefault(THREADS, '1')
    if KERNEL not in os.environ:
        kernel = _kernel_of_numpy() if 'numpy' in sys.modules else _kernel_of_processor()
        if kernel:
            os.environ[KERNEL] = kernel


def threads() -> int:
    """Return the number of threads that the environment names, 1 where it names none."""
    named = os.environ.get(THREADS, '')
    return max(1, int(named)) if named.isdecimal() else 1


def _kernel_of_processor() -> str | None:
    if os.uname().machine != 'x86_64':
        return None
    with _PROCESSOR.open(encoding='utf-8', errors='replace') as lines:
        flags = next((line for line in lines if line.startswith('flags')), '')
    return HASWELL if {*flags.split()} >= _NEEDED else None


def _kernel_of_numpy() -> str | None:
    # Only here: most programs do not need it.
    from ddct_plant.program.arithmetic import blas_libraries

    return next((each.kernel for each in blas_libraries() if each.kernel), None)
