# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
One thread for the numerics of a floor, also in a program that was started without `ddct`.

More threads only wait for one another, which takes several times as long.
"""

import ctypes
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache

from ddct_bringup.digests.processor import loaded_libraries

VARIABLE = 'OPENBLAS_NUM_THREADS'
"""Environment variable with the number of threads that a user wants."""
_NAMES = (
    ('scipy_openblas_', '64_'),
    ('scipy_openblas_', ''),
    ('openblas_', '64_'),
    ('openblas_', ''),
)
"""Beginning and end of the names of OpenBLAS's functions, by the builds of its packages."""


@contextmanager
def one_thread() -> Iterator[None]:
    """Let OpenBLAS use one thread within the block, unless the variable has a number of them."""
    libraries = () if VARIABLE in os.environ else thread_counts()
    before = [count() for count, _ in libraries]
    try:
        for _, limit in libraries:
            limit(1)
        yield
    finally:
        for (_, limit), number in zip(libraries, before, strict=True):
            limit(number)


@cache
def thread_counts() -> tuple[tuple[Callable[[], int], Callable[[int], None]], ...]:
    """Return the functions that get and set the number of threads, of each OpenBLAS in use."""
    found = []
    for path in sorted(loaded_libraries()):
        library = ctypes.CDLL(str(path))
        for begin, end in _NAMES:
            count = getattr(library, f'{begin}get_num_threads{end}', None)
            limit = getattr(library, f'{begin}set_num_threads{end}', None)
            if count and limit:
                limit.restype = None
                found.append((count, limit))
                break
    return tuple(found)
