# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Types of `result.json`; docs/use/benchmark.md describes what its keys mean."""

from typing import TypedDict

from ddct_bringup.campaign_report.summary_types import PairSummary, Quantiles, Reason
from ddct_bringup.digests.origin import OriginEntry


class RunShare(TypedDict):
    """Number of runs, their share among all runs of the set, 0 to 1, and its interval."""

    runs: int
    share: float | None
    interval: list[float] | None


class WorstCase(TypedDict):
    """Largest magnitude, with its case; null without one."""

    value: float | None
    case: int | None


class ValueSpread(Quantiles):
    """Distribution over the engaged runs that have a value."""

    with_value: int
    worst: WorstCase


class QuantityResult(ValueSpread):
    """Distribution of one metric or criterion, and of its ratio to the floor."""

    name: str
    unit: str
    over_floor: ValueSpread | None
    """Value over the least at the run's own lock instant; null for a quantity without floors."""


class ScenarioResult(TypedDict):
    """Result of a controller in one scenario."""

    success: RunShare
    quantities: list[QuantityResult]
    """Main quantities only."""


class LimitsResult(TypedDict):
    """Limits in the cases with floors, without those that no controller can keep."""

    runs: int
    """Number of runs in cases with floors."""
    unavoidable: int
    """Number of limits that no controller can keep, over these cases."""
    avoidable: int
    """Number of the other limits, over these cases."""
    kept: int
    share: float | None
    """Share of the avoidable limits that were kept."""
    all_kept: RunShare
    """Runs that kept all avoidable limits, among those in cases with floors."""


class KeyEffect(TypedDict):
    """Effect of one varied key on failure, as in the summary of a campaign."""

    key: str
    drives: bool
    explained: float
    interval: list[float]
    p_value: float
    worst_part: str
    """Part of the key's range, or the scenario, in which failure is most frequent."""
    worst_part_runs: int
    worst_part_failed: int


class Causes(TypedDict):
    """Keys that drive failure; none where failed runs, or others, are too few."""

    too_few: str
    keys: list[KeyEffect]


class Evaluation(TypedDict):
    """Result of one controller on one set of cases."""

    controller: str
    runs: int
    success: RunShare
    """Runs that are engaged or nearly engaged."""
    states: dict[str, RunShare]
    """Every state that occurred, `invalid` included."""
    scenarios: dict[str, ScenarioResult]
    reasons: list[Reason]
    """Reasons for invalid runs."""
    quantities: list[QuantityResult]
    limits: LimitsResult
    causes: Causes | None
    """Null of a controller that only runs beside the judged one."""
    non_dominated: bool


class BoardRow(TypedDict):
    """One controller among all of the release, on the development cases."""

    controller: str
    judged: bool
    success: RunShare
    limits: LimitsResult
    medians: dict[str, float | None]
    """
    Median of each main quantity over all cases, in its unit.

    A run that did not engage counts as worse than any value; null where half of them or more are.
    """
    non_dominated: bool


class Gap(TypedDict):
    """Difference of one figure between development and held-out cases."""

    name: str
    p_value: float | None
    """Probability of such a difference by chance; null without values."""
    worse: float | None
    """
    Probability that a held-out run is worse than one of development; 0.5 where they are alike.
    """
    differs: bool
    """Whether it is beyond chance, with all figures of the controller taken together."""


class JudgedResult(TypedDict):
    """Result of one judged controller."""

    controller: str
    digests: dict[str, str]
    """SHA-256 of the files that it is made of, or of its package."""
    held_out_seed: int
    error: str | None
    """Reason why its cases could not be computed; the parts below are then null."""
    development: list[Evaluation] | None
    """The judged controller, then those that run beside it."""
    held_out: list[Evaluation] | None
    """The same on the held-out cases."""
    gaps: list[Gap] | None
    development_pairs: list[PairSummary] | None
    """The judged controller less each of the others, on the same cases."""
    held_out_pairs: list[PairSummary] | None


class CasesResult(TypedDict):
    """Cases that were run."""

    digest: str
    quick: bool
    scenarios: list[str]
    samples: int
    floor_samples: int
    varied: list[str]
    development_seed: int
    release_rows: OriginEntry
    """Code that computed the kept rows of our controllers."""
    other_code: str
    """What to know where that is other code than `release`; empty where it is the same."""


class Method(TypedDict):
    """Methods of intervals and tests."""

    share_interval: str
    difference_interval: str
    gap_of_shares: str
    gap_of_quantities: str
    causes: str
    confidence: float
    non_dominated: list[str]
    """Figures that are compared to find who is not dominated."""


class Result(TypedDict):
    """Content of `result.json`."""

    schema_version: int
    release: OriginEntry
    """Code of the release that judged."""
    cases: CasesResult
    judge_seed: int | None
    """Seed of a judge for the held-out cases; null where it follows from the digests."""
    method: Method
    controllers: list[JudgedResult]
    board: list[BoardRow]
    """Every judged controller, then all controllers of the release."""
