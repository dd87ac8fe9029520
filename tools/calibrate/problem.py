# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The calibration of the scenario `thesis` as a least-squares problem.

The thesis prints no engine torque profile, no reference slope and no PI gains. They are fitted
to nine numbers, the LS8, Hinf1 and PI rows of its Table 5.1, without the MPC rows.
"""

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ddct_bringup.reproduction.study_run import study_run
from ddct_bringup.thesis.table_5_1 import CALIBRATED, ROW_OF, THESIS_TABLE
from ddct_controllers.design.analysis.loops import sampled_plant
from ddct_controllers.linear import PI_OPTIONS
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rad_s_from_rpm
from ddct_plant.models.engine import TorqueProfile
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.control import ReferenceParameters
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

Values = Sequence[float] | np.ndarray
"""Values of the parameters, (6,), in the order of PARAMETERS."""
ROWS = tuple(row.controller for row in THESIS_TABLE if row.use == CALIBRATED)
"""Controllers whose rows are fitted."""


@dataclass(frozen=True)
class FittedParameter:
    """One fitted number and its bounds, whose reasons are in docs/thesis/predictions.md."""

    symbol: str
    unit: str
    lower: float
    upper: float

    @property
    def range(self) -> float:
        """Distance of the bounds."""
        return self.upper - self.lower


PARAMETERS = (
    FittedParameter('C_m start', 'N m', 0.0, 60.0),
    FittedParameter('C_m end', 'N m', 150.0, 350.0),
    FittedParameter('rise end', 's', 0.3, 0.6),
    FittedParameter('reference slope', 'rad/s^2', 40.0, 160.0),
    FittedParameter('K_p', 'N m/rpm', 0.0, 0.3),
    FittedParameter('K_i', 'N m/(rpm s)', 0.0, 0.5),
)
LOWER = np.array([parameter.lower for parameter in PARAMETERS])
RANGE = np.array([parameter.range for parameter in PARAMETERS])


class Problem:
    """Residuals of the fitted rows for one score window, by the values of the parameters."""

    def __init__(self, base: Scenario, window_end_s: float) -> None:
        """Take what is not fitted from a scenario; the score window starts with control."""
        self.base, self.window_end_s = base, window_end_s
        # A change of the gains alone runs the PI alone.
        self._residuals_of = lru_cache(maxsize=32)(self._run)

    def scenario(self, values: Values) -> Scenario:
        """Return the scenario for the (6,) values of PARAMETERS."""
        start, end, rise_end, slope, *gains = (float(value) for value in values)
        return dataclasses.replace(
            self.base,
            score_window_s=(self.base.control_start_s, self.window_end_s),
            engine=TorqueProfile((0.0, rise_end), (start, end)),
            reference=ReferenceParameters(slope),
            controllers={'pi': dict(zip(PI_OPTIONS, gains, strict=True))},
        )

    def residuals(self, values: Values) -> np.ndarray:
        """Return (computed / printed - 1) / tolerance, (9,), three values a row."""
        shared, gains = tuple(values[:4]), tuple(values[4:])
        rows = [self._residuals_of(row, *shared, *(gains * (row == 'pi'))) for row in ROWS]
        return np.concatenate(rows)

    def _run(self, row: str, *values: float) -> np.ndarray:
        """
        Return the residuals of one row, (3,), simulated to the end of the score window.

        Where w_d does not reach zero by then, t_a is the time simulated since control start plus
        the time that the slope of the reference needs for the remaining slip: defined everywhere,
        continuous, and larger for a worse run. Raise DdctError for a run that is not finite.
        """
        scenario = self.scenario((*values, 0.0, 0.0)[: len(PARAMETERS)])
        shortened = dataclasses.replace(scenario, duration_s=self.window_end_s)
        run = study_run(RunSettings(KnownSettings(shortened)), row)
        found, final_rpm = run.table_values, run.metrics['slip_final_rpm']
        if found['engagement_time_s'] is None and final_rpm is not None:
            left = abs(rad_s_from_rpm(final_rpm)) / scenario.reference.slope_rad_s2
            found['engagement_time_s'] = self.window_end_s - scenario.control_start_s + left
        deviations = ROW_OF[row].scaled_deviations(found)
        missing = [name for name, value in deviations.items() if value is None]
        if missing:
            raise DdctError(f'{row} has no {", ".join(missing)}: narrow the bounds')
        return np.array([*deviations.values()])


def values_of(scenario: Scenario) -> tuple[float, ...]:
    """Return the (6,) values of PARAMETERS; raise ParameterError for another kind of scenario."""
    engine = scenario.engine
    gains = {name: option.default for name, option in PI_OPTIONS.items()}
    gains |= scenario.controllers.get('pi', {})
    if len(engine.time_s) != 2 or engine.time_s[0] != 0.0:
        raise ParameterError(
            f'scenario {scenario.name} is not of the calibrated kind: engine torque from 0 s in '
            'one straight rise',
            key='engine',
        )
    slope = scenario.reference.slope_rad_s2
    return (*engine.torque_n_m, engine.time_s[1], slope, *gains.values())


def pi_growth_rate(
    parameters: DrivelineParameters, proportional_gain: float, integral_gain: float
) -> float:
    """
    Return the growth rate in 1/s of the loop's slowest-decaying mode; positive is unstable.

    State: request after its delay, actuator and driveline sampled at 10 ms, the integral of e.
    Load constant, clutch new, no saturation; u = -(K_p e + K_i integral of e), e = -w_d in rpm.
    """
    plant = sampled_plant(parameters)
    loop = np.block(
        [
            [plant.a + proportional_gain * plant.b @ plant.c, -integral_gain * plant.b],
            [-PERIOD_S * plant.c, np.ones((1, 1))],
        ]
    )
    return float(np.log(np.max(np.abs(np.linalg.eigvals(loop)))) / PERIOD_S)
