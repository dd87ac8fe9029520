# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Random numbers of a campaign; each is a function of root seed, key and case alone.

So a case draws the same however the work is shared, wherever it goes on, and whatever else varies.
The bits are those of the generator Philox 4x64, whose counter is the case; numpy keeps them.
"""

import hashlib
from functools import cache

import numpy as np
from numpy.random import Philox, SeedSequence

_WORDS = 4
"""Number of 32-bit words in the hash of a key."""
_LARGEST_SEED = 2**31
"""Exclusive upper bound of the seeds of runs."""
_SEED = ' seed of the run'
"""Key of the seeds of runs; no other key begins with a space."""


def uniform(root: int, key: str, case: int) -> float:
    """Return a uniform random number between 0 and 1, both excluded, from the 53 highest bits."""
    return ((_bits(root, key, case) >> 11) + 0.5) * 2.0**-53


def run_seed(root: int, case: int) -> int:
    """Return the seed of the random numbers within the runs of a case."""
    return _bits(root, _SEED, case) % _LARGEST_SEED


def _bits(root: int, key: str, case: int) -> int:
    return int(Philox(key=_stream(root, key), counter=case).random_raw())


@cache
def _stream(root: int, key: str) -> np.ndarray:
    """Return the key of the generator, (2,), for one varied key of a campaign."""
    digest = hashlib.sha256(key.encode()).digest()
    words = [int.from_bytes(digest[4 * i : 4 * i + 4], 'little') for i in range(_WORDS)]
    return SeedSequence([root, *words]).generate_state(2, 'uint64')
