# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Record of `design h-infinity`: one type for each object of its JSON."""

from collections.abc import Mapping
from typing import Literal, TypedDict

from ddct_controllers.design.analysis.margins import MarginEntry
from ddct_controllers.design.function_entry import FunctionEntry


class HinfSpecifications(TypedDict):
    """Time specifications, and their bounds by the second-order prototype."""

    rise_time_s: float
    overshoot: float
    """Overshoot as a fraction of the final value."""
    damping: float
    sensitivity_peak: float
    complementary_peak: float
    natural_frequency_rad_s: float


class WeightEntry(TypedDict):
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


class CleaningEntry(TypedDict):
    """One rule that was applied, and the factors that it removed."""

    rule: str
    removed: str


class NormEntry(TypedDict):
    """Peaks over frequency of weighted functions, as `WeightedNorms` defines them."""

    sensitivity: float
    complementary: float
    uncertainty: float
    stack: float


class UnstableLoopEntry(TypedDict):
    """A loop that is unstable, of which nothing else is computed."""

    stable: Literal[False]


class StableLoopEntry(MarginEntry):
    """Margins, step response and weighted norms of a stable loop."""

    rise_time_s: float | None
    """Rise time in s; None where the final value is never reached."""
    overshoot: float
    """Overshoot as a fraction of the final value."""
    meets_specifications: bool
    """Whether rise time and overshoot are as specified."""
    norms: NormEntry


LoopEntry = StableLoopEntry | UnstableLoopEntry


class LoopsEntry(TypedDict):
    """Loops of one controller."""

    continuous_loop: LoopEntry | None
    """Loop without hold and delay; None for a design with both in its plant."""
    sampled_loop: LoopEntry


class HinfProvenance(LoopsEntry):
    """Provenance of a design, as it stands in the controller's file."""

    method: str
    specifications: HinfSpecifications
    weights: WeightEntry
    gamma: float
    cleaning: list[CleaningEntry]


class SynthesisEntry(TypedDict):
    """Norms of the closed loop with the weights: the optimum, its bound, and the level taken."""

    method: str
    optimum: float
    lower_bound: float
    gamma: float


class HinfCorners(TypedDict):
    """Sampled loops at the corners of the driveline, over wear; the worst of them."""

    corners: int
    """Number of corners."""
    unstable: int
    """Number of corners that are unstable at some wear gain."""
    sensitivity_peak: float | None
    """Peak M_s at the worst corner; None where a corner is unstable."""
    wear_gain: float
    factors: Mapping[str, float]
    """Multiples of the driveline's nominal parameters at the worst corner, by name."""


class HinfRecord(HinfProvenance):
    """A design and its verified quantities."""

    name: str
    synthesis: SynthesisEntry
    raw_controller: FunctionEntry
    """Controller from the synthesis: in s, or in w for a sampled design."""
    controller: FunctionEntry
    """Controller after cleaning, in the same variable."""
    pulse_transfer_function: FunctionEntry
    """Controller G_c(z) as it runs."""
    corners: HinfCorners


class UncertaintyRecord(TypedDict):
    """The fitted and the printed W_u."""

    largest_error: float
    """Largest relative error of the plant over the range of K_usura."""
    fitted: FunctionEntry
    printed: FunctionEntry
    printed_falls_short_by: float
    """Largest relative amount by which the printed W_u is below the error."""
    printed_falls_short_above_rad_s: float | None
    """Frequency in rad/s above which the printed W_u is below the error; None for none."""
