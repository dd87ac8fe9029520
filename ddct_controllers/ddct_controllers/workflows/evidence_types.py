# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Frequency-domain evidence, `frequency.json`: one type for each object of the JSON."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from ddct_controllers.design.analysis.margins import LoopMargins
from ddct_plant.files.json_records import Inline


@dataclass(frozen=True)
class ActuatorConditions:
    """Actuator of the loops."""

    delay_s: float
    bandwidth_factor: float


@dataclass(frozen=True)
class EvidenceConditions:
    """Conditions that all loops of the evidence share."""

    scenario: str
    """Name of the scenario."""
    scenario_digest: str
    period_s: float
    """Sampling period in s."""
    actuator: Inline[ActuatorConditions]
    wear_gain_range: Sequence[float]
    """Lowest and highest wear gain of the corners."""
    corners: int
    """Number of corners of the driveline."""
    corner_spread: float
    """Relative change of each parameter at a corner."""
    corner_parameters: Sequence[str]
    """Names of the parameters that differ between corners."""


@dataclass(frozen=True)
class PointEntry:
    """Sampled loop at one wear gain: its margins, and the mode of the driveline."""

    wear_gain: float
    margins: Inline[LoopMargins]
    driveline_mode_hz: float | None
    """Frequency in Hz; None, as the other two, for a loop without an oscillating pole."""
    driveline_mode_damping: float | None
    driveline_mode_torsion_rpm: float | None


@dataclass(frozen=True)
class WorstCornerEntry:
    """Sampled loop at the worst corner."""

    factors: Mapping[str, float]
    """Multiples of the nominal parameters, by name."""
    point: Inline[PointEntry]


@dataclass(frozen=True)
class CornersEntry:
    """Sampled loops at all corners of the driveline, over wear."""

    unstable_corners: int
    """Number of corners that are unstable at some wear gain."""
    sensitivity_peak: float | None
    """Largest peak M_s; None where a corner is unstable."""
    least_driveline_mode_damping: float | None
    worst: WorstCornerEntry


@dataclass(frozen=True)
class WearInterval:
    """Wear gains between which the loop is stable."""

    lowest: float
    highest: float | None
    """Highest wear gain; None where nothing limits it."""


@dataclass(frozen=True)
class LinearEntry:
    """Evidence of one linear controller."""

    controller: str
    linear: Literal[True]
    nominal: PointEntry
    """Loop of a new clutch."""
    stable_wear_gain: WearInterval | None
    """Interval of wear gains; None where the loop of a new clutch is unstable."""
    wear: list[PointEntry]
    """Loops by rising wear gain."""
    corners: CornersEntry


@dataclass(frozen=True)
class EntryWithoutEvidence:
    """Entry of a controller that is not linear, or whose `linear_model` cannot be used."""

    controller: str
    linear: Literal[False] | None
    """False where it is not linear; None where its `linear_model` cannot be used."""
    nominal: None
    stable_wear_gain: None
    wear: None
    corners: None


ControllerEntry = LinearEntry | EntryWithoutEvidence


@dataclass(frozen=True)
class FrequencyEvidence:
    """Evidence of several controllers, in their order."""

    conditions: EvidenceConditions
    controllers: list[ControllerEntry]


def linear_entries(evidence: FrequencyEvidence) -> list[LinearEntry]:
    """Return the entries of the linear controllers."""
    return [entry for entry in evidence.controllers if isinstance(entry, LinearEntry)]
