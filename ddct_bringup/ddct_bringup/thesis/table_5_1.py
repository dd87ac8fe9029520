# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Table 5.1 as printed, and which of its rows the scenario was fitted to."""

from collections.abc import Mapping
from dataclasses import dataclass

from ddct_bringup.thesis.table_metrics import TABLE_METRICS
from ddct_plant.scenario.file import load_scenario, scenario_digest
from ddct_plant.scenario.settings import RunSettings

CALIBRATED = 'calibrated'
PREDICTED = 'predicted'


@dataclass(frozen=True)
class ThesisRow:
    """One printed row; its values have the names of `metrics.Metrics`."""

    label: str
    """Name in the thesis."""
    controller: str
    """Name in the controller registry."""
    engagement_time_s: float
    """Engagement time t_a in s, from control start to w_d = 0."""
    torsion_speed_std_rpm: float
    """
    Standard deviation of w_sr in rpm; the thesis prints no unit, and rpm is the one that fits.
    """
    acceleration_std_m_s2: float
    """Standard deviation of A_x in m/s^2."""
    use: str
    """Use of the row: CALIBRATED, the scenario was fitted to it, or PREDICTED, it was not."""

    def printed_values(self) -> dict[str, float]:
        """Return the three printed values by metric name."""
        return {name: getattr(self, name) for name in TABLE_METRICS}

    def cells(self) -> tuple[str, ...]:
        """Return the three values as text, with the printed digits."""
        return tuple(f'{value:g}' for value in self.printed_values().values())

    def scaled_deviations(self, values: Mapping[str, float | None]) -> dict[str, float | None]:
        """
        Return (computed / printed - 1) / tolerance by metric name, None for an undefined value.

        The tolerances are those of the fitted rows.
        """
        deviations: dict[str, float | None] = {}
        for name, printed in self.printed_values().items():
            value = values[name]
            deviations[name] = (
                None if value is None else (value / printed - 1.0) / TOLERANCES[name]
            )
        return deviations

    def hit(self, name: str, value: float | None) -> bool:
        """Return whether a predicted value is within the tolerance; an undefined one is not."""
        printed = self.printed_values()[name]
        return value is not None and abs(value / printed - 1.0) <= PREDICTION_TOLERANCE

    def verdict(self, name: str, value: float | None) -> str:
        """Return `hit` or `miss` for a predicted value."""
        return 'hit' if self.hit(name, value) else 'miss'


FORMS = dict(zip(TABLE_METRICS, ('.3f', '.2f', '.3f'), strict=True))
"""Formats of the computed values by metric."""
TOLERANCES = dict(zip(TABLE_METRICS, (0.05, 0.10, 0.10), strict=True))
"""
Largest relative deviation of each fitted value from the printed one.

The calibration scales its residuals by it. The rounding of the print (0.5 % of t_a, up to 3 % of a
sigma) is not a useful tolerance: no parameters of the model come that close, so it would only
decide which values are sacrificed.
"""
PREDICTION_TOLERANCE = 0.25
"""Largest relative deviation of a predicted value, as in the list of numbers."""

THESIS_TABLE = (
    ThesisRow('LS8', 'ls8', 0.71, 1.15, 0.20, CALIBRATED),
    ThesisRow('Hinf1', 'hinf1', 0.79, 0.87, 0.17, CALIBRATED),
    ThesisRow('MPC3', 'mpc3', 0.63, 0.90, 0.19, PREDICTED),
    ThesisRow('MPC4', 'mpc4', 0.52, 0.20, 0.06, PREDICTED),
    ThesisRow('PI', 'pi', 0.88, 0.70, 0.18, CALIBRATED),
)
"""Rows of Table 5.1 (Chapter 5), in its order."""
PREDICTED_ROWS = [row for row in THESIS_TABLE if row.use == PREDICTED]
ROW_OF = {row.controller: row for row in THESIS_TABLE}
"""Rows by registry name of the controller."""


def thesis_row(controller: str) -> ThesisRow | None:
    """Return the row of a registry name, None for a controller that is not in the table."""
    return ROW_OF.get(controller)


def is_thesis_run(settings: RunSettings) -> bool:
    """
    Return whether a run has the conditions of the thesis.

    They are its unchanged scenario, the detailed architecture, and a new clutch.
    """
    return (
        settings.detailed
        and settings.case.wear_gain == 1.0
        and scenario_digest(settings.scenario) == scenario_digest(load_scenario('thesis'))
    )
