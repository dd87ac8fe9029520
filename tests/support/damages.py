# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Damages of a bag: flipped bits, cuts and zeroed blocks, each refused or without effect."""

import operator
import random
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.base.errors import DdctError


def damages(whole: bytes, count: int, seed: int) -> Iterator[bytes]:
    """Yield a file with a flipped bit, a zeroed block or without its end, in turn."""
    rng = random.Random(seed)
    for number in range(count):
        place = rng.randrange(len(whole))
        if number % 3 == 0:
            flipped = bytes([whole[place] ^ 1 << rng.randrange(8)])
            yield whole[:place] + flipped + whole[place + 1 :]
        elif number % 3 == 1:
            size = min(rng.choice([1, 9, 100, 512, 4096]), len(whole) - place)
            yield whole[:place] + bytes(size) + whole[place + size :]
        else:
            yield whole[: rng.choice([place, len(whole) - place % 100])]


def tried_damages(file: Path, run: Trajectory, count: int, seed: int) -> Counter[str]:
    """
    Read a bag of a run, damaged in many ways; return the numbers of the outcomes.

    Assert that each is refused in one line that names the file, or gives the signals of the run:
    all of them, or of an unfinished bag their beginning.
    """
    whole, outcomes = file.read_bytes(), Counter[str]()
    for damaged in damages(whole, count, seed):
        file.write_bytes(damaged)
        try:
            recording = read_bag(file)
        except DdctError as error:
            assert file.name in str(error) and '\n' not in str(error), error
            outcomes['refused'] += 1
            continue
        outcomes['unfinished' if recording.unfinished else 'without effect'] += 1
        steps = recording.trajectory.steps
        assert recording.unfinished or steps == run.steps
        for name, values in recording.trajectory.signals.items():
            expected = run.signals[name][: steps + 1]
            same = np.array_equal if isinstance(values, np.ndarray) else operator.eq
            assert same(values, expected), name
    return outcomes
