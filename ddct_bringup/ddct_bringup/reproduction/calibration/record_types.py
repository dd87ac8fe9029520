# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Record of a calibration, as in `docs/thesis/calibration.json`: a type for each JSON object."""

from collections.abc import Mapping
from dataclasses import dataclass

from ddct_plant.files.json_records import Inline


@dataclass(frozen=True)
class ResidualEntry:
    """One value of a printed row beside the computed one."""

    row: str
    """Name of the row's controller."""
    figure: str
    """Name of the metric."""
    printed: float
    computed: float
    deviation: float
    """Relative deviation of the computed value from the printed one."""
    tolerance: float
    """Largest relative deviation within tolerance."""


@dataclass(frozen=True)
class FitEntry:
    """A local optimum."""

    objective: float
    """Half the sum of the squared scaled residuals."""
    worst_residual: float
    """Scaled residual of the largest size, with its sign."""
    values: Mapping[str, float]
    """Fitted parameters by name."""


@dataclass(frozen=True)
class OptimumEntry:
    """A local optimum of a search, with the loop of its PI."""

    window_end_s: float
    """End of the score window in s."""
    pi_kind: str
    """Part of the PI that moves the torque more: 'P' or 'I'."""
    pi_growth_rate_per_s: float
    pi_stable: bool
    fit: Inline[FitEntry]


@dataclass(frozen=True)
class LeftOutEntry:
    """A fit to two rows, and its values of the third."""

    row: str
    """Name of the row that is left out."""
    gains_from_row: bool
    """Whether the PI's gains are fitted to this row after all, as no other depends on them."""
    fit: Inline[FitEntry]
    figures: list[ResidualEntry]
    """Values of the row that is left out."""


@dataclass(frozen=True)
class AssumptionEntry:
    """A fit with one changed assumption."""

    change: str
    """Name of the change."""
    fit: Inline[FitEntry]


@dataclass(frozen=True)
class FittedParameterEntry:
    """One fitted parameter."""

    name: str
    symbol: str
    unit: str
    lower: float
    upper: float
    bounds_from: str
    """Source of the bounds."""
    value: float
    """Value at the optimum."""
    frozen: float
    """Value in the scenario file."""
    at_bound: bool
    std: float
    """Standard deviation."""
    std_given_start: float | None
    """Standard deviation for a fixed C_m start; None for C_m start."""


@dataclass(frozen=True)
class DerivedEntry:
    """A torque level or a slope that follows from the fitted parameters."""

    quantity: str
    unit: str
    value: float
    std: float
    """Standard deviation."""
    std_given_start: float
    """Standard deviation for a fixed C_m start."""


@dataclass(frozen=True)
class ObjectiveEntry:
    """The least objective, and the size of the problem."""

    value: float
    residual_tolerances: Mapping[str, float]
    """Relative tolerances by metric."""
    numbers: int
    """Number of printed values that are fitted to."""
    fitted: int
    """Number of fitted values, the end of the score window included."""


@dataclass(frozen=True)
class IdentifiabilityEntry:
    """The linear analysis at the optimum, as `Identifiability` defines it."""

    degrees_of_freedom: int
    residual_std: float
    coverage_95: float
    singular_values: list[float]
    directions: list[list[float]]
    weakest: Mapping[str, float]
    """Change of the parameters with the least effect on residuals, by name."""
    correlation_given_start: list[list[float]]


@dataclass(frozen=True)
class CalibrationRecord:
    """The whole calibration."""

    objective: ObjectiveEntry
    score_window_s: list[float]
    """Start and end of the score window in s."""
    parameters: list[FittedParameterEntry]
    torque_and_slopes: list[DerivedEntry]
    residuals: list[ResidualEntry]
    """Residuals at the values of the scenario file."""
    frozen_objective: float
    """Objective at the values of the scenario file."""
    windows: list[OptimumEntry]
    """Optima by the end of the score window."""
    starts: list[OptimumEntry]
    """Optima from every start, in the chosen window."""
    identifiability: IdentifiabilityEntry
    left_out: list[LeftOutEntry]
    assumptions: list[AssumptionEntry]


@dataclass(frozen=True)
class CheckRecord:
    """Check of the frozen scenario: its residuals, and a local refit from its values."""

    score_window_s: list[float]
    """Start and end of the score window in s."""
    residuals: list[ResidualEntry]
    frozen_objective: float
    refit: FitEntry
    moved: Mapping[str, float]
    """Changes by the refit, by name, as shares of the parameters' ranges."""
