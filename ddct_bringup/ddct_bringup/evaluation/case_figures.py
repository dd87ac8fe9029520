# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The five figures by which controllers are compared; of each less is better."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ddct_bringup.metrics.catalogue import METRICS
from ddct_plant.program.table import Quantity

LEVEL = 0.05
"""Level of the tests of all figures together."""
RESPONSE = Quantity(
    key='response_s',
    symbol='response',
    unit='s',
    form='.3f',
    meaning='time to the final lock, and the time by which the torque is late',
    undefined='one of both has no value',
)


@dataclass(frozen=True)
class ComparedFigure:
    """A figure, the columns whose sum it is, and the least difference that counts in a case."""

    quantity: Quantity
    columns: tuple[str, ...]
    least_difference: float
    """Least difference in the unit of the figure."""

    @property
    def name(self) -> str:
        """Key of the figure."""
        return self.quantity.key

    def values_in(self, columns: Mapping[str, np.ndarray]) -> np.ndarray:
        """
        Return the values of runs from their columns by name, (cases,) each.

        A sum is NaN where a part is: a linear clutch has no lock, a run without a demand no torque
        that is late.
        """
        values: np.ndarray = np.sum([columns[name] for name in self.columns], axis=0)
        return values


def _metric(key: str, least_difference: float) -> ComparedFigure:
    return ComparedFigure(METRICS[key], (key,), least_difference)


FIGURES = (
    ComparedFigure(RESPONSE, ('time_to_final_lock_s', 'torque_late_s'), 0.02),
    _metric('peak_jerk_m_s3', 0.1),
    _metric('friction_work_j', 20.0),
    _metric('weighted_acceleration_m_s2', 0.01),
    _metric('releases', 0.5),
)


@dataclass(frozen=True, eq=False)
class CaseFigures:
    """
    Successes and figures of one controller.

    Raise ValueError where the shapes do not fit.
    """

    success: np.ndarray
    """Whether each run is a success, (cases,) bool."""
    values: np.ndarray
    """Values of `FIGURES`, (figures, cases) in their units; NaN where a run has none."""

    def __post_init__(self) -> None:
        """Check the shapes."""
        if self.values.shape != (len(FIGURES), len(self.success)):
            raise ValueError(
                f'figures of the shape {self.values.shape} do not fit {len(FIGURES)} figures in '
                f'{len(self.success)} cases'
            )

    @classmethod
    def of(cls, success: np.ndarray, columns: Mapping[str, np.ndarray]) -> 'CaseFigures':
        """Return the figures of runs from their columns by name, (cases,) each."""
        return cls(success, np.array([each.values_in(columns) for each in FIGURES]))

    @property
    def cases(self) -> int:
        """Number of cases."""
        return len(self.success)

    @property
    def without_value(self) -> np.ndarray:
        """Whether a run is a success that has no value of a figure, (figures, cases) bool."""
        return self.success & np.isnan(self.values)

    @property
    def failures_worst(self) -> np.ndarray:
        """
        Values with failures as worse than any success, (figures, cases).

        They are infinite in a failed run, whatever its figures are, and NaN in a success without
        a value.
        """
        return np.where(self.success, self.values, np.inf)
