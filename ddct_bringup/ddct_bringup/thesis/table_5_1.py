"""Table 5.1 as printed, which of its rows were fitted to, and what may stand beside them."""

from dataclasses import dataclass

from ddct_plant.scenario.file import load_scenario, scenario_digest
from ddct_plant.scenario.settings import RunSettings

CALIBRATED = 'calibrated'
PREDICTED = 'predicted'


@dataclass(frozen=True)
class ThesisRow:
    """One printed row; the figures have the names that `metrics.Metrics` gives ours."""

    label: str
    """Name in the thesis."""
    controller: str
    """Name in the controller registry."""
    engagement_time_s: float
    """t_a, from control start to w_d = 0."""
    torsion_speed_std_rpm: float
    """Standard deviation of w_sr; the thesis prints no unit, rpm is the one that fits."""
    acceleration_std_m_s2: float
    """Standard deviation of A_x."""
    use: str
    """CALIBRATED: the scenario was fitted to it. PREDICTED: it took no part in the fit."""

    def figures(self) -> dict[str, float]:
        """Return the three printed figures by metric name."""
        return {name: getattr(self, name) for name in FIGURES}

    def cells(self) -> tuple[str, ...]:
        """Return them as they are printed."""
        return tuple(f'{value:g}' for value in self.figures().values())

    def hit(self, name: str, value: float | None) -> bool:
        """Return whether a predicted figure is near enough; an undefined one is not."""
        printed = self.figures()[name]
        return value is not None and abs(value / printed - 1.0) <= PREDICTION_TOLERANCE

    def verdict(self, name: str, value: float | None) -> str:
        """Return the same in a word."""
        return 'hit' if self.hit(name, value) else 'miss'


FIGURES = ('engagement_time_s', 'torsion_speed_std_rpm', 'acceleration_std_m_s2')
"""Metrics that the table has, in its order."""
FORMS = dict(zip(FIGURES, ('.3f', '.2f', '.3f'), strict=True))
"""Formats in which our figures are shown."""
TOLERANCES = dict(zip(FIGURES, (0.05, 0.10, 0.10), strict=True))
"""
Relative deviation from the print that each fitted figure may have.

For the calibration it is the unit of the scaled residuals. The rounding of the print (0.5 % of
t_a, up to 3 % of a sigma) is no measure there: no parameters of the model come that close, so it
would only say which figures to sacrifice.
"""
PREDICTION_TOLERANCE = 0.25
"""The same of a predicted figure, as the thesis gate states it."""

THESIS_TABLE = (
    ThesisRow('LS8', 'ls8', 0.71, 1.15, 0.20, CALIBRATED),
    ThesisRow('Hinf1', 'hinf1', 0.79, 0.87, 0.17, CALIBRATED),
    ThesisRow('MPC3', 'mpc3', 0.63, 0.90, 0.19, PREDICTED),
    ThesisRow('MPC4', 'mpc4', 0.52, 0.20, 0.06, PREDICTED),
    ThesisRow('PI', 'pi', 0.88, 0.70, 0.18, CALIBRATED),
)
"""Table 5.1 (Chapter 5), in its order."""
PREDICTED_ROWS = [row for row in THESIS_TABLE if row.use == PREDICTED]
ROW_OF = {row.controller: row for row in THESIS_TABLE}
"""The rows by registry name."""


def thesis_row(controller: str) -> ThesisRow | None:
    """Return the row of a registry name, None for a controller that the table does not have."""
    return ROW_OF.get(controller)


def is_thesis_run(settings: RunSettings) -> bool:
    """
    Return whether a run has the thesis's own conditions.

    They are its scenario unchanged, the detailed architecture, and the linear clutch, new.
    """
    return (
        settings.detailed
        and settings.clutch == 'linear'
        and settings.wear_gain == 1.0
        and scenario_digest(settings.scenario) == scenario_digest(load_scenario('thesis'))
    )
