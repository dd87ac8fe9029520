# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Costs of the predictive controllers: Table 4.1, Section 4.3, and our own variants."""

import math
from dataclasses import dataclass, replace

from ddct_controllers.mpc.model.transmission_model import (
    SLIP_ACCELERATION,
    SLIP_SPEED,
    TORSION_SPEED,
)
from ddct_controllers.mpc.program.settings import (
    MOST_STEPS,
    InputTerms,
    MpcSettings,
    OutputTerms,
    weight,
)
from ddct_plant.base.options import OptionGroup
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.models.actuator import PRINTED_ACTUATOR, ActuatorParameters
from ddct_plant.models.gearbox import EngagedGear
from ddct_plant.models.parameters import DrivelineParameters

PREDICTION_STEPS = 7
"""Prediction horizon of MPC4 in periods with the printed actuator: T_p = 0.07 s."""
SLIP_WEIGHT, SLIP_ACCELERATION_WEIGHT = 1.0, math.sqrt(0.05)
"""
Weights of w_d per rad/s and of dw_d/dt per rad/s^2: square roots, as (4.1) does not square Q.
"""
DEMAND_WEIGHT = 0.14
"""Weight of the difference of C_m and the demand, per N m; derived in docs/controllers/mpc.md."""


@dataclass(frozen=True)
class TableRow(OptionGroup):
    """One row of Table 4.1; a scenario may change all of it."""

    prediction_steps: int
    """Prediction horizon T_p in periods."""
    control_steps: int
    """Control horizon T_c in periods."""
    output_weight: float = weight(0.26, 'Q: weight per rpm of the slip error')
    final_weight: float = weight(0.0, 'P: weight per rpm of the slip error at the end')
    move_weight: float = weight(0.39, 'R: weight per N m of a move of the torque u')
    torque_weight: float = weight(0.0, 's: weight per N m of u: R on u, as Section 4.1 has it')
    preview: bool = False

    def settings(
        self,
        driveline: DrivelineParameters | None = None,
        actuator: ActuatorParameters = PRINTED_ACTUATOR,
    ) -> MpcSettings:
        """Return the row's settings; docs/thesis/readings.md has other readings of Q and R."""
        slip, at_the_end = map(rpm_from_rad_s, (self.output_weight, self.final_weight))
        return MpcSettings(
            prediction_steps=self.prediction_steps,
            control_steps=self.control_steps,
            outputs=(OutputTerms(SLIP_SPEED, slip, at_the_end),),
            inputs=(InputTerms(self.move_weight, self.torque_weight),),
            preview=self.preview,
        )


TABLE_4_1 = {'mpc1': TableRow(12, 3), 'mpc2': TableRow(16, 6), 'mpc3': TableRow(22, 4)}
BASIS = TABLE_4_1['mpc3']
"""Row of Table 4.1 with the horizon and the weights of our own controllers."""
PREVIEW = replace(BASIS, preview=True)
"""Cost of our own controllers: `BASIS` with preview of the reference."""


def default_torsion_weight(gear: EngagedGear) -> float:
    """
    Return the weight per rpm of w_sr at which it costs as much as slip.

    w_sr is a speed at the wheels; at the primary shaft, where slip is measured, it is tau times
    as large, and there 1 rpm of either costs the same.
    """
    return float(gear.shaft_speed(BASIS.output_weight))


@dataclass(frozen=True)
class TorsionCost(OptionGroup):
    """Cost of `PREVIEW`, with w_sr as a second output."""

    torsion_weight: float | None = weight(
        None, 'weight of w_sr per rpm; 0 is `mpc_offset_free`', '0.26 tau'
    )

    def settings(
        self, driveline: DrivelineParameters, actuator: ActuatorParameters = PRINTED_ACTUATOR
    ) -> MpcSettings:
        """Return the settings with the weight of w_sr, or the driveline's default for it."""
        per_rpm = self.torsion_weight
        if per_rpm is None:
            per_rpm = default_torsion_weight(driveline.gear)
        settings = PREVIEW.settings()
        torsion = OutputTerms(TORSION_SPEED, rpm_from_rad_s(per_rpm))
        return replace(settings, outputs=(*settings.outputs, torsion))


@dataclass(frozen=True)
class TwoInputCost(OptionGroup):
    """Cost of MPC4: slip, its rate, and the deviation of C_m from the demand (Section 4.3)."""

    slip_acceleration_weight: float = weight(
        SLIP_ACCELERATION_WEIGHT,
        'weight of dw_d/dt per rad/s², squared in the cost; w_d has 1 per rad/s',
    )
    demand_weight: float = weight(DEMAND_WEIGHT, 'r: weight per N m between C_m and the demand')

    def settings(
        self,
        driveline: DrivelineParameters | None = None,
        actuator: ActuatorParameters = PRINTED_ACTUATOR,
    ) -> MpcSettings:
        """
        Return the settings of this cost; R = P = 0, inputs constant over the horizon.

        The horizon is as much longer as the actuator lags more: within its lag no request acts.
        """
        longer = max(actuator.lag_s / PRINTED_ACTUATOR.lag_s, 1.0)
        return MpcSettings(
            prediction_steps=min(round(PREDICTION_STEPS * longer), MOST_STEPS),
            control_steps=1,
            outputs=(
                OutputTerms(SLIP_SPEED, SLIP_WEIGHT),
                OutputTerms(SLIP_ACCELERATION, self.slip_acceleration_weight),
            ),
            inputs=(InputTerms(), InputTerms(target_weight=self.demand_weight)),
            preview=False,
            along_tangent=True,
        )
