# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Random numbers of a campaign; each is a function of root seed, key and case alone.

So a case draws the same however the work is shared, wherever it goes on, and whatever else varies.
The bits are those of the generator Philox 4x64, whose counter is the case; numpy keeps them.
"""

import hashlib
from collections.abc import Callable
from functools import cache
from typing import TypeVar

import numpy as np
from numpy.random import Philox, SeedSequence

Draw = TypeVar('Draw')
_WORDS = 4
"""Number of 32-bit words in the hash of a key, and of 64-bit words for one counter."""
_LARGEST_SEED = 2**31
"""Exclusive upper bound of the seeds of runs."""
_SEED = ' seed of the run'
"""Key of the seeds of runs; no other key begins with a space."""


def uniforms(root: int, key: str, cases: range) -> list[float]:
    """Return a uniform random number between 0 and 1, both excluded, for each of some cases."""
    return [((bits >> 11) + 0.5) * 2.0**-53 for bits in _bits(root, key, cases)]


def run_seeds(root: int, cases: range) -> list[int]:
    """Return the seed of the random numbers within the runs of each of some cases."""
    return [bits % _LARGEST_SEED for bits in _bits(root, _SEED, cases)]


def drawn_in_part(
    draw: Callable[[range], list[Draw]], cases: range, samples: int, left_out: int
) -> list[Draw]:
    """
    Return the random numbers of some successive cases in a part of a campaign.

    Of the whole campaign the first `samples` at each point of the grid run, and the `left_out`
    samples after them do not. `draw` returns the numbers of cases of the whole one.
    """
    if not left_out:
        return draw(cases)
    drawn: list[Draw] = []
    first = cases.start
    while first < cases.stop:
        point = first // samples
        end = min(cases.stop, (point + 1) * samples)
        drawn += draw(range(first + point * left_out, end + point * left_out))
        first = end
    return drawn


def _bits(root: int, key: str, cases: range) -> list[int]:
    """Return 64 random bits for each of some successive cases; one counter gives four words."""
    generator = Philox(key=_stream(root, key), counter=cases.start)
    return [int(word) for word in generator.random_raw(_WORDS * len(cases))[::_WORDS]]


@cache
def _stream(root: int, key: str) -> np.ndarray:
    """Return the key of the generator, (2,), for one varied key of a campaign."""
    digest = hashlib.sha256(key.encode()).digest()
    words = [int.from_bytes(digest[4 * i : 4 * i + 4], 'little') for i in range(_WORDS)]
    return SeedSequence([root, *words]).generate_state(2, 'uint64')
