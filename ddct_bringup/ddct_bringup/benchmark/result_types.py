# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Types of `result.json`; docs/use/benchmark.md describes what its keys mean."""

from dataclasses import dataclass

from ddct_bringup.benchmark.update_times import UpdateTimesFile
from ddct_bringup.evaluation.held_out_gaps import Gap
from ddct_bringup.evaluation.summary import GroupSummary, Summary
from ddct_bringup.manifest.origin import CodeOrigin
from ddct_plant.files.json_records import Inline


@dataclass(frozen=True)
class JudgedResult:
    """Result of one judged controller, whose development cases stand in those of all."""

    controller: str
    digests: dict[str, str]
    """SHA-256 of the files that it is made of, or of its package."""
    held_out_seed: int
    error: str | None
    """Reason why its cases could not be computed; the parts below are then null."""
    held_out: Summary | None
    """Held-out cases: the judged controller, then those that run beside it."""
    gaps: tuple[Gap, ...] | None
    """Gap of each of the five figures between development and held-out cases."""


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
class ComparisonMethod:
    """Methods by which controllers and sets of cases are compared."""

    gap: str
    figures: tuple[str, ...]
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
    comparison: ComparisonMethod
    development: Summary | None
    """
    Development cases: every judged controller, then all of the release.

    Its pairs are those of the judged controllers; null where no cases could be computed.
    """
    controllers: tuple[JudgedResult, ...]

    @property
    def judged(self) -> tuple[JudgedResult, ...]:
        """Controllers that have results."""
        return tuple(each for each in self.controllers if each.held_out)

    def side_by_side(self, judged: JudgedResult) -> tuple[tuple[GroupSummary, GroupSummary], ...]:
        """Return development and held-out cases of a judged controller and of those beside it."""
        if not (self.development and judged.held_out):
            return ()
        return tuple(
            (self.development.group(each.controller), each) for each in judged.held_out.groups
        )


@dataclass(frozen=True)
class ResultWithTimes:
    """Result with the update times, as `--json` has it."""

    result: Inline[Result]
    update_times: UpdateTimesFile
