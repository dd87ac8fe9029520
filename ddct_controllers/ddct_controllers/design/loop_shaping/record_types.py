# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Records of `design loop-shaping`: one type for each object of their JSON."""

from collections.abc import Mapping
from dataclasses import dataclass

from ddct_controllers.design.analysis.margins import LoopMargins
from ddct_controllers.design.loop_shaping.verification import Contour
from ddct_plant.files.json_records import Inline
from ddct_plant.linear.lti import FactoredTransferFunction


@dataclass(frozen=True)
class LoopEntry:
    """Margins of a loop, and its behaviour at the curves of 14 % overshoot."""

    unstable_poles: int
    margins: Inline[LoopMargins]
    contours: list[Contour]


@dataclass(frozen=True)
class StepEntry:
    """One step from K_c/s to G_c1."""

    step: str
    found: Inline[LoopEntry]


@dataclass(frozen=True)
class ThesisLoopEntry:
    """The loop of one controller in one version, such as with the delay."""

    controller: str
    loop: str
    """Version of the loop."""
    found: Inline[LoopEntry]


@dataclass(frozen=True)
class PlacementEntry:
    """One version of G_c2 with quantities of its continuous loop."""

    version: str
    controller: Inline[FactoredTransferFunction]
    crossover_rad_s: float | None
    complementary_peak: float | None
    rise_time_s: float | None
    overshoot: float
    """Overshoot as a fraction of the final value."""


@dataclass(frozen=True)
class ThesisRecord:
    """Chapter 2 of the thesis, step by step."""

    network_steps: list[StepEntry]
    placement: list[PlacementEntry]
    loops: list[ThesisLoopEntry]


@dataclass(frozen=True)
class LoopShapingSpecifications:
    """Time specifications, and their bounds by the second-order prototype."""

    rise_time_s: float
    overshoot: float
    """Overshoot as a fraction of the final value."""
    sensitivity_peak: float
    complementary_peak: float
    crossover_rad_s: float


@dataclass(frozen=True)
class SampledLoopEntry:
    """Verified quantities of the sampled loop."""

    rise_time_s: float | None
    overshoot: float | None
    """Overshoot as a fraction of the final value."""
    margins: Inline[LoopMargins]
    stable_with_wear_gain: Mapping[str, bool]
    """Whether the loop is stable, by the wear gain as text."""


@dataclass(frozen=True)
class LoopShapingProvenance:
    """Provenance of a design, as it stands in the controller's file."""

    method: str
    scenario: str
    """Scenario of the driveline and the actuator, and its values that are changed."""
    structure: str
    integrators: int
    """Number of integrators."""
    specifications: LoopShapingSpecifications
    sampled_loop: SampledLoopEntry


@dataclass(frozen=True)
class LoopShapingRecord:
    """A design and its verified quantities."""

    name: str
    controller: FactoredTransferFunction
    provenance: Inline[LoopShapingProvenance]
    contours: list[Contour]
