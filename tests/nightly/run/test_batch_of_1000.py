# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A run in a batch of 1000 has the bits that it has alone."""

import numpy as np
from batch_runs import bits_of, short_run

SOME = slice(0, 1000, 25)


def test_a_run_does_not_depend_on_999_others() -> None:
    chosen = [short_run(seed) for seed in range(1000)]
    together = bits_of(chosen)
    order = np.random.default_rng(0).permutation(1000).tolist()
    assert bits_of([chosen[place] for place in order]) == [together[place] for place in order]
    assert together[SOME] == [bits_of([run])[0] for run in chosen[SOME]]
