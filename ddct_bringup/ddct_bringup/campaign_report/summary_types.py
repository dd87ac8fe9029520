# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Types of `summary.json`; the page on campaigns describes what its keys mean."""

from typing import TypedDict


class Quantiles(TypedDict):
    """Quantiles P5, P50 and P95; null without a value."""

    p5: float | None
    p50: float | None
    p95: float | None


class ShareOfRuns(TypedDict):
    """Share of the valid runs, 0 to 1, and its interval; null without a valid run or a sample."""

    share: float | None
    interval: list[float] | None


class StateSummary(ShareOfRuns):
    """Valid runs in one state."""

    runs: int


class Reason(TypedDict):
    """Reason for invalid runs, their number, and the index of the first."""

    reason: str
    runs: int
    index: int


class FailedSummary(ShareOfRuns):
    """Numbers of runs of a group by outcome, and the share of the failed ones."""

    runs: int
    engaged: int
    failed: int
    invalid: int
    no_interval: str
    """Reason for the missing interval, empty where there is one."""
    states: dict[str, StateSummary]
    reasons: list[Reason]


class RunReference(TypedDict):
    """Index and state of a run; null without one."""

    index: int | None
    state: str | None


class RunValue(RunReference):
    """Value of a quantity in one run."""

    value: float | None


class BoundarySide(RunReference):
    """Boundary of failure on one side of a line, as in `FailureBoundary`, and its first run."""

    last_good: float | None
    first_failure: float | None
    failed: int
    runs: int
    invalid: int


class BoundarySummary(TypedDict):
    """Boundaries of failure on a line over one key."""

    key: str
    nominal: float | None
    start: float
    others: dict[str, float]
    """Values of the grid's other numbers by key."""
    below: BoundarySide
    above: BoundarySide


class PartSummary(TypedDict):
    """Runs in one part of a key's range, from `low` to `high`."""

    low: float
    high: float
    runs: int
    failed: int


class EffectSummary(TypedDict):
    """Effect of one key on failure, as in `Effect`."""

    key: str
    drives: bool
    explained: float
    interval: list[float]
    p_value: float
    worst_part: PartSummary


class AttributionSummary(TypedDict):
    """Keys that drive failure; none where the failed runs are too few."""

    runs: int
    failed: int
    too_few: str
    """Reason for the missing attribution, empty where there is one."""
    keys: list[EffectSummary]


class QuantitySummary(Quantiles):
    """Distribution of a quantity over the engaged runs of a group, and its worst cases."""

    name: str
    unit: str
    engaged: int
    with_value: int
    cvar_engaged: float | None
    worst_engaged: RunValue
    worst: RunValue


class GroupSummary(TypedDict):
    """Runs that are evaluated together."""

    controller: str
    varied: dict[str, str]
    """Names of the group besides the controller, by key."""
    failed: FailedSummary
    boundaries: list[BoundarySummary]
    attribution: AttributionSummary | None
    quantities: list[QuantitySummary]


class DifferenceSummary(Quantiles):
    """Difference of two controllers in one quantity, first minus second, by magnitude."""

    name: str
    unit: str
    cases: int
    interval: list[float] | None


class PairSummary(TypedDict):
    """Two controllers on the same cases."""

    first: str
    second: str
    varied: dict[str, str]
    cases: int
    both: int
    first_only: int
    second_only: int
    neither: int
    no_interval: str
    differences: list[DifferenceSummary]


class IntervalMethod(TypedDict):
    """Method and confidence of the intervals of shares."""

    method: str
    confidence: float


class OtherVersionSummary(TypedDict):
    """Differences of results from those of this version; all empty where there are none."""

    absent: list[str]
    unknown: list[str]
    no_nominal: str


class Summary(TypedDict):
    """Content of `summary.json`."""

    schema_version: int
    runs: int
    grid: list[str]
    random: list[str]
    interval: IntervalMethod
    attribution_method: str
    difference_interval_method: str
    tail_share: float
    other_version: OtherVersionSummary
    groups: list[GroupSummary]
    pairs: list[PairSummary]
