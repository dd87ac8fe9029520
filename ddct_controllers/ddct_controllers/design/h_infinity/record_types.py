# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Record of `design h-infinity`: one type for each object of its JSON."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from ddct_controllers.design.analysis.margins import LoopMargins
from ddct_controllers.design.h_infinity.cleaning import CleaningStep
from ddct_controllers.design.h_infinity.uncertainty import WeightedNorms
from ddct_plant.files.json_records import Inline
from ddct_plant.linear.lti import FactoredTransferFunction


@dataclass(frozen=True)
class HinfSpecifications:
    """Time specifications, and their bounds by the second-order prototype."""

    rise_time_s: float
    overshoot: float
    """Overshoot as a fraction of the final value."""
    damping: float
    sensitivity_peak: float
    complementary_peak: float
    natural_frequency_rad_s: float


@dataclass(frozen=True)
class WeightEntry:
    """Numbers of the weights W_s and W_t, and of the one on the torque where there is one."""

    recipe: str
    low_frequency_gain: float
    sensitivity_corner_rad_s: float
    offset_rad_s: float
    bandwidth_rad_s: float
    complementary_damping: float
    effort_n_m_per_rpm: float | None
    effort_corner_rad_s: float | None
    hold_and_delay_in_plant: bool
    back_off: float
    """Level of the controller over the optimum."""


@dataclass(frozen=True)
class UnstableLoopEntry:
    """A loop that is unstable, of which nothing else is computed."""

    stable: Literal[False]


@dataclass(frozen=True)
class StableLoopEntry:
    """Margins, step response and weighted norms of a stable loop."""

    margins: Inline[LoopMargins]
    rise_time_s: float | None
    """Rise time in s; None where the final value is never reached."""
    overshoot: float
    """Overshoot as a fraction of the final value."""
    meets_specifications: bool
    """Whether rise time and overshoot are as specified."""
    norms: WeightedNorms


LoopEntry = StableLoopEntry | UnstableLoopEntry


@dataclass(frozen=True)
class LoopsEntry:
    """Loops of one controller."""

    continuous_loop: LoopEntry | None
    """Loop without hold and delay; None for a design with both in its plant."""
    sampled_loop: LoopEntry


@dataclass(frozen=True)
class HinfProvenance:
    """Provenance of a design, as it stands in the controller's file."""

    method: str
    scenario: str
    """Scenario of the driveline and the actuator, and its values that are changed."""
    specifications: HinfSpecifications
    weights: WeightEntry
    gamma: float
    cleaning: tuple[CleaningStep, ...]
    loops: Inline[LoopsEntry]


@dataclass(frozen=True)
class SynthesisEntry:
    """Norms of the closed loop with the weights: the optimum, its bound, and the level taken."""

    method: str
    optimum: float
    lower_bound: float
    gamma: float


@dataclass(frozen=True)
class HinfCorners:
    """Sampled loops at the corners of the driveline, over wear; the worst of them."""

    corners: int
    """Number of corners."""
    unstable_corners: int
    """Number of corners that are unstable at some wear gain."""
    sensitivity_peak: float | None
    """Peak M_s at the worst corner; None where a corner is unstable."""
    wear_gain: float
    factors: Mapping[str, float]
    """Multiples of the driveline's nominal parameters at the worst corner, by name."""


@dataclass(frozen=True)
class HinfRecord:
    """A design and its verified quantities."""

    name: str
    provenance: Inline[HinfProvenance]
    synthesis: SynthesisEntry
    raw_controller: FactoredTransferFunction
    """Controller from the synthesis: in s, or in w for a sampled design."""
    controller: FactoredTransferFunction
    """Controller after cleaning, in the same variable."""
    pulse_transfer_function: FactoredTransferFunction
    """Controller G_c(z) as it runs."""
    corners: HinfCorners


@dataclass(frozen=True)
class UncertaintyRecord:
    """The fitted and the printed W_u."""

    largest_error: float
    """Largest relative error of the plant over the range of K_usura."""
    fitted: FactoredTransferFunction
    printed: FactoredTransferFunction
    printed_falls_short_by: float
    """Largest relative amount by which the printed W_u is below the error."""
    printed_falls_short_above_rad_s: float | None
    """Frequency in rad/s above which the printed W_u is below the error; None for none."""


@dataclass(frozen=True)
class HinfResult:
    """A design with W_u beside it, and the specifications that it does not meet."""

    record: Inline[HinfRecord]
    uncertainty: UncertaintyRecord
    lacks: list[str]


@dataclass(frozen=True)
class HinfOrigin:
    """Provenance in a controller's file, with the specifications that the design does not meet."""

    provenance: Inline[HinfProvenance]
    lacks: list[str]
