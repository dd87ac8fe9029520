# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Types of `summary.json`; the page on campaigns describes what its keys mean."""

from dataclasses import dataclass

from ddct_bringup.campaign_report.results import OtherVersion
from ddct_bringup.campaign_report.statistics.paired import JointOutcomes, PairedDifference
from ddct_bringup.campaign_report.statistics.spread import Quantiles
from ddct_plant.files.json_records import Inline


@dataclass(frozen=True)
class StateSummary:
    """Valid runs in one state."""

    runs: int
    share: float | None
    """Share of the valid runs, 0 to 1; None without one."""
    interval: tuple[float, float] | None
    """Interval of the share; None without a sample."""


@dataclass(frozen=True)
class Reason:
    """Reason for invalid runs, their number, and the index of the first."""

    reason: str
    runs: int
    index: int


@dataclass(frozen=True)
class FailedSummary:
    """Numbers of runs of a group by outcome, and the share of the failed ones."""

    runs: int
    engaged: int
    failed: int
    invalid: int
    share: float | None
    """Share of the valid runs, 0 to 1; None without one."""
    interval: tuple[float, float] | None
    """Interval of the share; None without a sample."""
    no_interval: str
    """Reason for the missing interval, empty where there is one."""
    states: dict[str, StateSummary]
    reasons: list[Reason]


@dataclass(frozen=True)
class RunValue:
    """Value of a quantity in one run, with its index and state; all None without one."""

    value: float | None
    index: int | None
    state: str | None


@dataclass(frozen=True)
class BoundarySide:
    """Boundary of failure on one side of a line, as in `FailureBoundary`, and its first run."""

    last_good: float | None
    first_failure: float | None
    failed: int
    runs: int
    invalid: int
    index: int | None
    state: str | None


@dataclass(frozen=True)
class BoundarySummary:
    """Boundaries of failure on a line over one key."""

    key: str
    nominal: float | None
    start: float
    others: dict[str, float]
    """Values of the grid's other numbers by key."""
    below: BoundarySide
    above: BoundarySide


@dataclass(frozen=True)
class PartSummary:
    """Runs in one part of a key's range, from `low` to `high`."""

    low: float
    high: float
    runs: int
    failed: int


@dataclass(frozen=True)
class EffectSummary:
    """Effect of one key on failure, as in `Effect`."""

    key: str
    drives: bool
    explained: float
    interval: tuple[float, float]
    p_value: float
    worst_part: PartSummary


@dataclass(frozen=True)
class AttributionSummary:
    """Keys that drive failure; none where the failed runs are too few."""

    runs: int
    failed: int
    too_few: str
    """Reason for the missing attribution, empty where there is one."""
    keys: list[EffectSummary]


@dataclass(frozen=True)
class QuantitySummary:
    """Distribution of a quantity over the engaged runs of a group, and its worst cases."""

    name: str
    unit: str
    engaged: int
    with_value: int
    quantiles: Inline[Quantiles]
    cvar_engaged: float | None
    worst_engaged: RunValue
    worst: RunValue


@dataclass(frozen=True)
class GroupSummary:
    """Runs that are evaluated together."""

    controller: str
    varied: dict[str, str]
    """Names of the group besides the controller, by key."""
    failed: FailedSummary
    boundaries: list[BoundarySummary]
    attribution: AttributionSummary | None
    quantities: list[QuantitySummary]


@dataclass(frozen=True)
class DifferenceSummary:
    """Difference of two controllers in one quantity, first minus second, by magnitude."""

    name: str
    unit: str
    difference: Inline[PairedDifference]


@dataclass(frozen=True)
class PairSummary:
    """Two controllers on the same cases."""

    first: str
    second: str
    varied: dict[str, str]
    outcomes: Inline[JointOutcomes]
    no_interval: str
    differences: list[DifferenceSummary]


@dataclass(frozen=True)
class IntervalMethod:
    """Method and confidence of the intervals of shares."""

    method: str
    confidence: float


@dataclass(frozen=True)
class Summary:
    """Content of `summary.json`."""

    schema_version: int
    runs: int
    grid: list[str]
    random: list[str]
    interval: IntervalMethod
    attribution_method: str
    difference_interval_method: str
    tail_share: float
    other_version: OtherVersion
    groups: list[GroupSummary]
    pairs: list[PairSummary]
