"""
Which scenarios the calibration admits: the rule, on the nine fitted figures alone.

A scenario is admissible when
- w_d reaches zero with each of the three fitted controllers, and each of the nine figures (rows
  LS8, Hinf1 and PI of Table 5.1), of its whole run in its own score window, is within the
  calibration's tolerance of the print: 5 % for t_a, 10 % for both sigmas,
- the PI loop is stable,
- every fitted value is within the bounds of the calibration.

The tolerances are the unit of the calibration's residuals and decide whether it has succeeded, so
the frozen scenario and every other that passes are equally good answers to it. No wider limit has
a reason of its own. Rows of a predictive controller are not looked at.
"""

from ddct_bringup.reproduction.calibration.parameters import (
    PARAMETERS,
    ROWS,
    Record,
    outside_tolerance,
    pi_growth_rate,
    residual_rows,
    values_of,
)
from ddct_bringup.reproduction.runs import headless_run
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import RunSettings


def why_not_admissible(scenario: Scenario) -> list[str]:
    """
    Return in words what the rule holds against a scenario; nothing for an admissible one.

    Raise ParameterError for a scenario that is not of the calibrated kind.
    """
    values = values_of(scenario)
    against = [
        f'{parameter.name} {value:g} is outside {parameter.lower:g} to {parameter.upper:g}'
        for parameter, value in zip(PARAMETERS, values, strict=True)
        if not parameter.lower <= value <= parameter.upper
    ]
    growth = pi_growth_rate(scenario.driveline, *values[4:])
    if growth >= 0.0:
        against.append(f'the PI loop grows by {growth:.2g}/s')
    figures = {row: _figures(scenario, row) for row in ROWS}
    for row, found in figures.items():
        missing = [name for name, value in found.items() if value is None]
        if missing:
            against.append(f'{row} has no {", ".join(missing)}')
    whole = {row: found for row, found in figures.items() if None not in found.values()}
    return against + outside_tolerance(residual_rows(whole))


def fitted_rows(scenario: Scenario) -> list[Record]:
    """Return the nine figures of the whole run, as in the record of the calibration."""
    return residual_rows({row: _figures(scenario, row) for row in ROWS})


def _figures(scenario: Scenario, controller: str) -> dict[str, float]:
    """Return the three figures of one controller by name; None for what is undefined."""
    return headless_run(RunSettings(scenario), controller).figures
