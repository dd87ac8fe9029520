# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The cases that episodes are drawn from: those of the benchmark, or distributions by key."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from ddct_bringup.api.arguments import base_from
from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.campaign.rows import SEED
from ddct_bringup.campaign.specification.distributions import Distribution
from ddct_bringup.campaign.specification.parts import GRID, RANDOM, SAMPLES, VARY, samples_of
from ddct_bringup.run.run_base import RunBase
from ddct_plant.scenario.case import require_spelt
from ddct_plant.scenario.settings import RunSettings

_SENSORS = 'sensors'
_SEEDS = 2**31


@dataclass(frozen=True)
class DrawnCases:
    """Cases of one scenario, drawn at random."""

    base: RunBase
    """Common settings of all cases."""
    vary: Mapping[str, Distribution]
    """Distributions by key."""
    common: Mapping[str, Any]
    """Values by key that all cases have besides."""

    @classmethod
    def of(cls, vary: Mapping[str, Any] | None, options: Mapping[str, Any]) -> Self:
        """
        Return the cases of the `options` of `run`, which vary as in a campaign's `random.vary`.

        None are the distributions and the sensors of the benchmark. Raise DdctError for a key or
        a value that cannot be used.
        """
        base, common = base_from((), **options), {}
        if vary is None:
            car = options.get('car')
            content = Cases.packaged(car=None if car is None else str(car)).content
            vary = content[RANDOM][VARY]
            common = {key: content[GRID][key][0] for key in content[GRID] if key == _SENSORS}
        drawn = samples_of({RANDOM: {SAMPLES: 1, VARY: vary}})[2] if vary else {}
        return cls(base, drawn, common)

    def draw(self, random: np.random.Generator) -> dict[str, Any]:
        """Return the values of a case by key, with the seed of its sensors."""
        shares = random.uniform(np.finfo(float).tiny, 1.0, len(self.vary))
        drawn = {
            key: each.value(share)
            for (key, each), share in zip(self.vary.items(), shares, strict=True)
        }
        return {**drawn, SEED: int(random.integers(_SEEDS))}

    def settings(self, case: Mapping[str, Any]) -> RunSettings:
        """Return the settings of the run of a case; raise DdctError where it cannot be built."""
        require_spelt(case)
        return self.base.at({**self.common, **case}, drawn=self.vary)
