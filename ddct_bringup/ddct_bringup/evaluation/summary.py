# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Types of a summary of many runs, which its JSON, its tables and its page have."""

from dataclasses import dataclass

from ddct_bringup.evaluation.attribution import Causes
from ddct_bringup.evaluation.boundaries import Boundary
from ddct_bringup.evaluation.dominance import PairedComparison
from ddct_bringup.evaluation.paired import JointOutcomes, PairedDifference
from ddct_bringup.evaluation.share import Share
from ddct_bringup.evaluation.spread import QuantitySummary
from ddct_plant.files.json_records import Inline

SCHEMA_VERSION = 3
"""Schema version of `summary.json`."""


@dataclass(frozen=True)
class OtherVersion:
    """Differences of results from those of this version; all empty where there are none."""

    absent: tuple[str, ...] = ()
    """Missing columns."""
    unknown: tuple[str, ...] = ()
    """Columns that do not exist in this version."""
    no_nominal: str = ''
    """Reason why the nominal values of the varied keys are not known."""


@dataclass(frozen=True)
class Reason:
    """Reason for invalid runs, their number, and the index of the first."""

    reason: str
    runs: int
    index: int


@dataclass(frozen=True)
class PartSummary:
    """Part of a group, such as its runs in one scenario."""

    engaged: Share
    quantities: dict[str, QuantitySummary]
    """Five figures by key, those that a run has; empty where they were not asked for."""


@dataclass(frozen=True)
class GroupSummary:
    """Runs that are evaluated together."""

    controller: str
    varied: dict[str, str]
    """Names of the group besides the controller, by key."""
    runs: int
    invalid: int
    engaged: Share
    """Successes among the runs that count."""
    failed: Share
    states: dict[str, Share]
    """Share of each state that occurred but `invalid`, those of another version last."""
    no_interval: str
    """Reason for missing intervals, empty where there are some."""
    reasons: tuple[Reason, ...]
    """Most frequent reasons for invalid runs."""
    parts: dict[str, PartSummary]
    """Parts of the group by name; empty without a key that divides it."""
    boundaries: tuple[Boundary, ...]
    """Boundaries of failure on a grid."""
    causes: Causes | None
    """Keys that drive failure; None without random keys, and where they were not asked for."""
    quantities: dict[str, QuantitySummary]
    """Quantities by key, those that a run of the table has."""
    dominated_by: tuple[str, ...] | None
    """Controllers that dominate this one; None where they were not compared."""

    @property
    def label(self) -> str:
        """Label of the group in tables."""
        return ', '.join([self.controller, *self.varied.values()])


@dataclass(frozen=True)
class PairSummary:
    """Two controllers on the same cases."""

    first: str
    second: str
    varied: dict[str, str]
    outcomes: Inline[JointOutcomes]
    no_interval: str
    differences: dict[str, PairedDifference]
    """Difference of each quantity by key, first minus second, by magnitude."""
    comparison: PairedComparison | None
    """Comparison by the five figures, case by case; None where there is none."""

    @property
    def label(self) -> str:
        """Label of the pair in tables."""
        return ', '.join([f'{self.first} less {self.second}', *self.varied.values()])


@dataclass(frozen=True)
class Method:
    """Methods of intervals and tests."""

    share_interval: str
    difference_interval: str
    causes: str
    confidence: float
    """Confidence of all intervals, 0 to 1."""
    tail_share: float
    """Share of the engaged runs that the conditional value at risk is of."""


@dataclass(frozen=True)
class Summary:
    """Summary of many runs."""

    runs: int
    grid: tuple[str, ...]
    """Keys that are varied on a grid."""
    random: tuple[str, ...]
    """Keys that are drawn at random."""
    method: Method
    other_version: OtherVersion
    groups: tuple[GroupSummary, ...]
    pairs: tuple[PairSummary, ...]

    @property
    def invalid(self) -> int:
        """Number of invalid runs."""
        return sum(group.invalid for group in self.groups)

    def group(self, controller: str) -> GroupSummary:
        """Return the first group of a controller; raise StopIteration without one."""
        return next(each for each in self.groups if each.controller == controller)

    def pair(self, first: str, second: str) -> PairSummary:
        """Return the pair of two controllers; raise StopIteration without it."""
        return next(each for each in self.pairs_of(first) if each.second == second)

    def pairs_of(self, controller: str) -> tuple[PairSummary, ...]:
        """Return the pairs of which a controller is the first."""
        return tuple(each for each in self.pairs if each.first == controller)


@dataclass(frozen=True)
class SummaryFile:
    """Content of the `summary.json` of a campaign."""

    schema_version: int
    summary: Inline[Summary]

    @classmethod
    def of(cls, summary: Summary) -> 'SummaryFile':
        """Return the content for a summary of this version."""
        return cls(SCHEMA_VERSION, summary)
