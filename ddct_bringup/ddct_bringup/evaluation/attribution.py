# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Attribution of failure to keys that were drawn independently.

The measure is the main effect of a key, the first-order sensitivity index (Saltelli et al. 2008,
Section 1.2.3): the part of the variance of failure that the key explains by itself,

    S = Var(E[failed | key]) / Var(failed), 0 to 1

It is estimated from the runs as they are, over parts of the key's range with equally many runs
(Plischke, Borgonovo and Smith 2013), and freed from what chance explains (Kelley's epsilon
squared). A key whose values are names has a part for each name. It needs no direction: a key that
causes failure at both ends counts too. It misses a key that acts through another alone, and is
less than S where failure begins within a part.

Whether a key drives failure is tested by permutation: failures are dealt out at random among the
runs. The p-values are Holm's, so that among all keys of a controller a false one is named in less
than 5 % of the campaigns. The interval of S is a bootstrap over the runs, by its pivot.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ddct_bringup.evaluation.parts import KeyPart, parts_of, worst_of
from ddct_bringup.evaluation.share import CONFIDENCE, Share

METHOD = 'main effect of each key, permutation test with Holm correction, bootstrap interval'
FEWEST = 5
"""Fewest failed runs, and fewest other runs, for an attribution to keys."""
_RUNS_IN_PART = 10
_DEALS = 5000
_RESAMPLES = 2000
_SEED = 0
"""Seed of the random numbers, so that the same runs give the same results."""


@dataclass(frozen=True)
class Effect:
    """Effect of one key on failure."""

    key: str
    drives: bool
    """Whether the key drives failure beyond chance."""
    explained: float
    """Main effect of the key on failure, 0 to 1."""
    interval: tuple[float, float]
    """Ends of the interval of the main effect, at `CONFIDENCE`."""
    p_value: float
    """Probability of such an effect by chance alone, corrected for the number of keys."""
    worst_part: KeyPart
    """Part of the range, or group of names, in which failure is most frequent."""


@dataclass(frozen=True)
class Causes:
    """Keys that drive failure; none where the failed runs, or the others, are too few."""

    failed: Share
    too_few: str
    """Reason for the missing keys, empty where there are some."""
    keys: tuple[Effect, ...]


def causes_of(values: Mapping[str, np.ndarray], failed: np.ndarray) -> Causes:
    """
    Return which keys drive (n,) failures.

    `values` has by key the (n,) numbers or names of the runs; keys of one value are left out.
    """
    share = Share(int(np.sum(failed)), len(failed))
    if why := too_few(failed):
        return Causes(share, why, ())
    varied = {key: each for key, each in values.items() if len(set(each.tolist())) > 1}
    return Causes(share, '', tuple(effects_of(varied, failed)))


def too_few(failed: np.ndarray) -> str:
    """Return why (n,) failures are too few for an attribution, empty if they are enough."""
    if not len(failed):
        return 'no valid run, so nothing says which keys drive failure'
    failures, others = int(np.sum(failed)), int(np.sum(~failed))
    if min(failures, others) >= FEWEST:
        return ''
    what = 'failed' if failures <= others else 'did not fail'
    return (
        f'{min(failures, others)} of {len(failed)} valid runs {what}: too few to say which keys '
        f'drive failure (at least {FEWEST})'
    )


def effects_of(values: Mapping[str, np.ndarray], failed: np.ndarray) -> list[Effect]:
    """
    Return the effect of each key, the largest first.

    `values` has by key the (n,) numbers or names of the runs, `failed` is (n,) and not `too_few`.
    """
    random = np.random.default_rng(_SEED)
    tables = {key: parts_of(each, failed, _RUNS_IN_PART) for key, each in values.items()}
    chances = {key: _chance(random, parts) for key, parts in tables.items()}
    corrected = holm(chances)
    found = [
        Effect(
            key,
            corrected[key] <= 1.0 - CONFIDENCE,
            *_explained_with_interval(random, parts),
            corrected[key],
            worst_of(parts),
        )
        for key, parts in tables.items()
    ]
    return sorted(found, key=lambda each: (each.p_value, -each.explained))


def _counts(parts: tuple[KeyPart, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Return the numbers of runs and of failed runs in each part, (parts,) each."""
    counts = [(part.failed.of, part.failed.count) for part in parts]
    runs, failed = np.array(counts).T
    return runs, failed


def _ratio(runs: np.ndarray, failed: np.ndarray) -> np.ndarray:
    """Return the share of failure's variance between parts, (...,), from (..., parts) counts."""
    total = runs.sum(axis=-1)
    mean = failed.sum(axis=-1) / total
    with np.errstate(all='ignore'):
        within = np.where(runs > 0, failed**2 / runs, 0.0).sum(axis=-1)
        ratio = (within / total - mean**2) / (mean * (1.0 - mean))
    return np.nan_to_num(ratio, nan=0.0, posinf=0.0, neginf=0.0)


def _without_chance(ratio: np.ndarray | float, runs: int, parts: int) -> np.ndarray | float:
    """Return epsilon squared of a ratio: the share that chance explains is subtracted."""
    return 1.0 - (1.0 - ratio) * (runs - 1) / (runs - parts)


def _chance(random: np.random.Generator, parts: tuple[KeyPart, ...]) -> float:
    """Return the probability that random failures are as unequal as these, 0 to 1."""
    runs, failed = _counts(parts)
    dealt = random.multivariate_hypergeometric(
        runs, int(failed.sum()), size=_DEALS, method='marginals'
    )
    as_unequal = np.sum(_ratio(runs, dealt) >= _ratio(runs, failed) * (1.0 - 1e-12))
    return float((1 + as_unequal) / (1 + _DEALS))


def _explained_with_interval(
    random: np.random.Generator, parts: tuple[KeyPart, ...]
) -> tuple[float, tuple[float, float]]:
    """Return the main effect and the ends of its interval, each within 0 to 1."""
    runs, failed = _counts(parts)
    total, count = int(runs.sum()), len(parts)
    if count >= total:  # a run in each part: all of the variance lies between them
        return 0.0, (0.0, 1.0)
    ratio = float(_ratio(runs, failed))
    explained = float(_without_chance(ratio, total, count))
    cells = np.concatenate([failed, runs - failed])
    drawn = random.multinomial(total, cells / total, size=_RESAMPLES)
    again_failed = drawn[:, :count]
    again = _without_chance(_ratio(again_failed + drawn[:, count:], again_failed), total, count)
    outside = (1.0 - CONFIDENCE) / 2.0
    low, high = np.quantile(again, [outside, 1.0 - outside]) - ratio
    ends = np.clip([explained - high, explained - low], 0.0, 1.0)
    return min(max(explained, 0.0), 1.0), (float(ends[0]), float(ends[1]))


def holm(chances: Mapping[str, float]) -> dict[str, float]:
    """Return p-values by key corrected for their number (Holm 1979)."""
    corrected: dict[str, float] = {}
    largest = 0.0
    for place, key in enumerate(sorted(chances, key=lambda key: chances[key])):
        largest = max(largest, min(1.0, (len(chances) - place) * chances[key]))
        corrected[key] = largest
    return corrected
