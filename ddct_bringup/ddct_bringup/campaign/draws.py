"""
Random numbers of a campaign: each is a function of root seed, key and case alone.

So a case draws the same however the work is shared, wherever it goes on, and whatever else varies.
The bits are those of the generator Philox 4x64, whose counter is the case; numpy keeps them.
"""

import hashlib
from functools import cache

import numpy as np
from numpy.random import Philox, SeedSequence

_WORDS = 4
"""Of 32 bits, of the hash of a key."""
_LARGEST_SEED = 2**31
"""Below which the seeds of runs are."""
_SEED = ' seed of the run'
"""Stands for a key; none begins with a space."""


def uniform(root: int, key: str, case: int) -> float:
    """Return a number between 0 and 1, both excluded, from the 53 highest bits."""
    return ((_bits(root, key, case) >> 11) + 0.5) * 2.0**-53


def run_seed(root: int, case: int) -> int:
    """Return the seed of the random numbers within the runs of a case."""
    return _bits(root, _SEED, case) % _LARGEST_SEED


def _bits(root: int, key: str, case: int) -> int:
    return int(Philox(key=_stream(root, key), counter=case).random_raw())


@cache
def _stream(root: int, key: str) -> np.ndarray:
    """Return the key of the generator that a campaign has for one of its keys, (2,)."""
    digest = hashlib.sha256(key.encode()).digest()
    words = [int.from_bytes(digest[4 * i : 4 * i + 4], 'little') for i in range(_WORDS)]
    return SeedSequence([root, *words]).generate_state(2, 'uint64')
