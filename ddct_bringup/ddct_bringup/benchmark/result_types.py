# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Types of `result.json`; docs/use/benchmark.md describes what its keys mean."""

from dataclasses import dataclass

from ddct_bringup.benchmark.update_times import UpdateTimesFile
from ddct_bringup.campaign_report.statistics.spread import Quantiles
from ddct_bringup.campaign_report.summary_types import PairSummary, Reason
from ddct_bringup.manifest.origin import CodeOrigin
from ddct_plant.files.json_records import Inline


@dataclass(frozen=True)
class RunShare:
    """Number of runs, their share among all runs of the set, 0 to 1, and its interval."""

    runs: int
    share: float | None
    interval: tuple[float, float] | None


@dataclass(frozen=True)
class WorstCase:
    """Largest magnitude, with its case; null without one."""

    value: float | None
    case: int | None


@dataclass(frozen=True)
class ValueSpread:
    """Distribution over the successes that have a value."""

    quantiles: Inline[Quantiles]
    with_value: int
    worst: WorstCase


@dataclass(frozen=True)
class QuantityResult:
    """Distribution of one quantity."""

    name: str
    unit: str
    spread: Inline[ValueSpread]


@dataclass(frozen=True)
class ScenarioResult:
    """Result of a controller in one scenario."""

    success: RunShare
    quantities: list[QuantityResult]
    """The five figures."""


@dataclass(frozen=True)
class KeyEffect:
    """Effect of one varied key on failure, as in the summary of a campaign."""

    key: str
    drives: bool
    explained: float
    interval: tuple[float, float]
    p_value: float
    worst_part: str
    """Part of the key's range, or the scenario, in which failure is most frequent."""
    worst_part_runs: int
    worst_part_failed: int


@dataclass(frozen=True)
class Causes:
    """Keys that drive failure; none where failed runs, or others, are too few."""

    too_few: str
    keys: list[KeyEffect]


@dataclass(frozen=True)
class Evaluation:
    """Result of one controller on one set of cases."""

    controller: str
    runs: int
    success: RunShare
    """Runs that are engaged."""
    states: dict[str, RunShare]
    """Every state that occurred, `invalid` included."""
    scenarios: dict[str, ScenarioResult]
    reasons: list[Reason]
    """Reasons for invalid runs."""
    quantities: list[QuantityResult]
    causes: Causes | None
    """Null of a controller that only runs beside the judged one."""


@dataclass(frozen=True)
class BoardRow:
    """One controller among all of the release, on the development cases."""

    controller: str
    judged: bool
    success: RunShare
    quantities: list[QuantityResult]
    """The five figures."""
    dominated_by: list[str] | None
    """Controllers that dominate it; null in a quick benchmark."""


@dataclass(frozen=True)
class FigureInCases:
    """One figure of the judged controller and another one, case by case."""

    name: str
    better: int
    """Number of cases in which the judged one is better."""
    worse: int
    left_out: int
    """Number of cases left out, since the figure is null by the case."""
    median_difference: float | None
    """Median of judged less other; null where failures of one alone decide it."""


@dataclass(frozen=True)
class PairedResult:
    """The judged controller and another one on the same cases."""

    other: str
    cases: int
    dominates: bool
    """Whether the judged controller dominates the other one."""
    dominated: bool
    """Whether the other one dominates the judged controller."""
    figures: list[FigureInCases]


@dataclass(frozen=True)
class Gap:
    """Difference of one figure between development and held-out cases."""

    name: str
    p_value: float | None
    """Probability that held-out runs are so much worse by chance; null without values."""
    worse: float | None
    """
    Probability that a held-out run is worse than one of development; 0.5 where they are alike.
    """
    left_out: int
    """Number of successes left out, since they have no value."""
    differs: bool
    """Whether it is beyond chance, with all figures of the controller taken together."""


@dataclass(frozen=True)
class JudgedResult:
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
    dominance: list[PairedResult] | None
    """Comparison with each other controller on the development cases; null where it is quick."""
    development_pairs: list[PairSummary] | None
    """The judged controller less each of the others, on the same cases."""
    held_out_pairs: list[PairSummary] | None


@dataclass(frozen=True)
class CasesResult:
    """Cases that were run."""

    digest: str
    quick: bool
    car: str | None
    """Name of the car, or its file in the result; null for the cars of the scenarios."""
    left_out: dict[str, str]
    """Reasons by name of the scenarios that the car cannot drive."""
    scenarios: list[str]
    samples: int
    varied: list[str]
    development_seed: int
    release_rows: CodeOrigin | None
    """Code that computed the kept rows of our controllers; null with a car: there are none."""
    other_code: str
    """What to know where that is other code than `release`; empty where it is the same."""


@dataclass(frozen=True)
class Method:
    """Methods of intervals and tests."""

    share_interval: str
    difference_interval: str
    gap: str
    causes: str
    confidence: float
    figures: list[str]
    """Figures that are compared."""
    dominance_level: float | None
    """Level of one figure of one ordered pair of controllers; null in a quick benchmark."""


@dataclass(frozen=True)
class Result:
    """Content of `result.json`."""

    schema_version: int
    release: CodeOrigin
    """Code of the release that judged."""
    cases: CasesResult
    judge_seed: int | None
    """Seed of a judge for the held-out cases; null where it follows from the digests."""
    method: Method
    controllers: list[JudgedResult]
    board: list[BoardRow]
    """Every judged controller, then all controllers of the release."""


@dataclass(frozen=True)
class ResultWithTimes:
    """Result with the update times, as `--json` has it."""

    result: Inline[Result]
    update_times: UpdateTimesFile
