# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Records of `design loop-shaping`: one type for each object of their JSON."""

from collections.abc import Mapping, Sequence
from typing import TypedDict

from ddct_controllers.design.analysis.margins import MarginEntry
from ddct_controllers.design.function_entry import FunctionEntry


class ContourEntry(TypedDict):
    """A closed curve that L has to stay out of, as `Contour` defines it."""

    name: str
    level: float
    peak: float
    peak_rad_s: float
    inside_rad_s: Sequence[tuple[float, float]]
    respected: bool


class LoopEntry(MarginEntry):
    """Margins of a loop, and its behaviour at the curves of 14 % overshoot."""

    unstable_poles: int
    contours: list[ContourEntry]


class StepEntry(LoopEntry):
    """One step from K_c/s to G_c1."""

    step: str


class ThesisLoopEntry(LoopEntry):
    """The loop of one controller in one version, such as with the delay."""

    controller: str
    loop: str
    """Version of the loop."""


class PlacementEntry(FunctionEntry):
    """One version of G_c2 with quantities of its continuous loop."""

    version: str
    crossover_rad_s: float | None
    complementary_peak: float | None
    rise_time_s: float | None
    overshoot: float
    """Overshoot as a fraction of the final value."""


class ThesisRecord(TypedDict):
    """Chapter 2 of the thesis, step by step."""

    network_steps: list[StepEntry]
    placement: list[PlacementEntry]
    loops: list[ThesisLoopEntry]


class LoopShapingSpecifications(TypedDict):
    """Time specifications, and their bounds by the second-order prototype."""

    rise_time_s: float
    overshoot: float
    """Overshoot as a fraction of the final value."""
    sensitivity_peak: float
    complementary_peak: float
    crossover_rad_s: float


class SampledLoopEntry(MarginEntry):
    """Verified quantities of the sampled loop."""

    rise_time_s: float | None
    overshoot: float | None
    """Overshoot as a fraction of the final value."""
    stable_with_wear_gain: Mapping[str, bool]
    """Whether the loop is stable, by the wear gain as text."""


class LoopShapingProvenance(TypedDict):
    """Provenance of a design, as it stands in the controller's file."""

    method: str
    structure: str
    integrators: int
    """Number of integrators."""
    specifications: LoopShapingSpecifications
    sampled_loop: SampledLoopEntry


class LoopShapingRecord(LoopShapingProvenance):
    """A design and its verified quantities."""

    name: str
    controller: FunctionEntry
    contours: list[ContourEntry]
