# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Figures of controllers on benchmarks that are drawn at random.

Levels differ from one scenario to another as in the release's rows, and within a scenario by 5 to
30 %. The case has the larger part of that, the same for all controllers, and a run the rest. The
hard cases of a scenario fail more often.
"""

from collections.abc import Callable, Iterable
from statistics import NormalDist

import numpy as np

from ddct_bringup.evaluation.case_figures import CaseFigures
from ddct_bringup.evaluation.dominance import dominators_of
from ddct_bringup.evaluation.held_out_gaps import gaps_of

SCENARIOS, SAMPLES = 11, 30
IN_SCENARIO = np.repeat(np.arange(SCENARIOS), SAMPLES)
"""Scenario of each case, (cases,)."""
COPIES = 30
RESPONSE, JERK = 0, 1
"""Places among the figures."""
_LEVELS = np.array([[0.4, 3.5], [2.0, 60.0], [70.0, 2e4], [0.08, 1.5]])
"""Range of the level of each figure but the releases over scenarios, in its unit."""


class MadeBenchmark:
    """A controller's level in each scenario, and sets of cases of it."""

    def __init__(self, random: np.random.Generator, failing: float = 0.1) -> None:
        """Draw the levels; `failing` is the share of runs that fail."""
        self._random = random
        shape = (4, SCENARIOS)
        least, most = np.log(_LEVELS).T[..., None]
        self._level = np.exp(random.uniform(least, most, shape))[:, IN_SCENARIO]
        self._spread = random.uniform(0.05, 0.3, shape)[:, IN_SCENARIO]
        shares = failing * random.uniform(0.1, 1.9, SCENARIOS)
        self._bearable = -np.array([NormalDist().inv_cdf(each) for each in shares])[IN_SCENARIO]
        self._releasing = random.choice([0.0, 0.0, 0.1, 1.0], SCENARIOS)[IN_SCENARIO]
        self.draw_cases()

    def draw_cases(self) -> None:
        """Draw other cases: what a case adds to each figure, and how hard it is."""
        self._of_case = self._random.normal(size=(4, len(IN_SCENARIO)))
        self._hardness = self._random.normal(size=len(IN_SCENARIO))

    def run(self) -> CaseFigures:
        """Return the figures of one copy of the controller on the cases drawn last."""
        random, cases = self._random, len(IN_SCENARIO)
        of_run = 0.7 * random.normal(size=cases) + 0.7 * random.normal(size=(4, cases))
        values = self._level * np.exp(self._spread * (0.8 * self._of_case + 0.6 * of_run))
        hardness = 0.8 * self._hardness + 0.6 * random.normal(size=cases)
        releases = random.poisson(self._releasing)
        return CaseFigures(hardness < self._bearable, np.vstack([values, releases]))

    def half_of_failures(self, run: CaseFigures) -> CaseFigures:
        """Return a run that fails half as often."""
        saved = self._random.random(run.cases) < 0.5
        return CaseFigures(run.success | saved, run.values)

    def better(
        self, run: CaseFigures, *, figure: int, by: float, part: float = 1.0
    ) -> CaseFigures:
        """Return a run with a figure that is less by a share, in a part of the scenarios."""
        factors = np.ones(run.values.shape)
        factors[figure, part * SCENARIOS > IN_SCENARIO] = 1.0 - by
        return CaseFigures(run.success, run.values * factors)


MEMORISERS: dict[str, Callable[[MadeBenchmark, CaseFigures], CaseFigures]] = {
    'a tenth less jerk': lambda made, run: made.better(run, figure=JERK, by=0.1),
    'a fifth less jerk': lambda made, run: made.better(run, figure=JERK, by=0.2),
    'a fifth less jerk in half of the scenarios': lambda made, run: made.better(
        run, figure=JERK, by=0.2, part=0.5
    ),
    'a tenth less response': lambda made, run: made.better(run, figure=RESPONSE, by=0.1),
    'no failures': lambda _, run: CaseFigures(np.ones_like(run.success), run.values),
}
"""What a memoriser does better in the development cases than in any others, by name."""
HALF_OF_FAILURES = 'half of the failures'
"""Memoriser that does not show in each draw."""
HONEST = 'honest'


def draws_with_a_dominated_copy(draws: int, seed: int) -> int:
    """Return in how many draws any of thirty copies of a controller is dominated."""
    found = 0
    for place in range(draws):
        made = MadeBenchmark(np.random.default_rng([seed, place]))
        copies = {str(number): made.run() for number in range(COPIES)}
        found += any(dominators_of(copies).values())
    return found


def flagged_draws(
    draws: int, seed: int, kinds: Iterable[str] = (HONEST, *MEMORISERS), failing: float = 0.1
) -> dict[str, int]:
    """Return in how many draws a controller of each kind has a gap in any figure."""
    memorisers = {**MEMORISERS, HALF_OF_FAILURES: MadeBenchmark.half_of_failures}
    found = dict.fromkeys(kinds, 0)
    for place in range(draws):
        made = MadeBenchmark(np.random.default_rng([seed, place]), failing)
        development = made.run()
        made.draw_cases()
        held_out = (made.run(), IN_SCENARIO)
        for kind in found:
            ours = memorisers[kind](made, development) if kind in memorisers else development
            found[kind] += any(each.differs for each in gaps_of((ours, IN_SCENARIO), held_out))
    return found
