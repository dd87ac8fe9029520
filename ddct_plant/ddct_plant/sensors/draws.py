"""The random numbers of a sensor: streams that follow from the seed and the quantity alone."""

import zlib
from collections.abc import Iterator

import numpy as np

from ddct_plant.sensors.parameters import SensorOptions

_BLOCK = 256
"""Numbers drawn at a time, which does not change them."""


def gaussian(seed: int, quantity: str) -> Iterator[float]:
    """Yield numbers of the standard normal distribution, one for each step."""
    random = _generator(seed, quantity, 'noise')
    while True:
        yield from random.standard_normal(_BLOCK).tolist()


def losses(seed: int, quantity: str, options: SensorOptions) -> Iterator[bool]:
    """
    Yield whether the sample of each step is lost; that of step 0 always comes.

    A chain of two states (Gilbert 1960) with the share p lost and runs of mean length L: a lost
    sample is followed by another with 1 - 1/L, one that came by a lost one with p / ((1 - p) L).
    With L = 1 / (1 - p) both are p: each sample is lost by itself.
    """
    share = options.dropout
    burst = options.dropout_burst or 1.0 / (1.0 - share)
    go_on, begin = 1.0 - 1.0 / burst, share / ((1.0 - share) * burst)
    random = _generator(seed, quantity, 'dropout')
    lost = False
    yield lost
    while True:
        for draw in random.random(_BLOCK).tolist():
            lost = draw < (go_on if lost else begin)
            yield lost


def _generator(seed: int, quantity: str, purpose: str) -> np.random.Generator:
    """Return a generator of its own, whatever else is drawn, by whom and in which order."""
    stream = zlib.crc32(f'{quantity} {purpose}'.encode())
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence([seed, stream])))
