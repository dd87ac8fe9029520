"""What the predictive controllers minimise: Table 4.1, Section 4.3, and what we make of them."""

import math
from dataclasses import dataclass, replace
from typing import Any, ClassVar

from ddct_controllers.interface import ControllerContext
from ddct_controllers.mpc.model.transmission_model import (
    SLIP_ACCELERATION,
    SLIP_SPEED,
    TORSION_SPEED,
)
from ddct_controllers.mpc.options import number_option
from ddct_controllers.mpc.program.settings import InputTerms, MpcSettings, OutputTerms
from ddct_plant.base.units import rpm_from_rad_s


@dataclass(frozen=True)
class TableRow:
    """One row of Table 4.1; its weights may be changed, T_p and T_c are `OPTIONS`."""

    prediction_steps: int
    """T_p in periods."""
    control_steps: int
    """T_c in periods."""
    output_weight: float = 0.26
    """Q, taken per rpm of the slip error."""
    final_weight: float = 0.0
    """P, per rpm of the slip error at the end of the horizon."""
    move_weight: float = 0.39
    """R, taken per N m of a move of the controller's torque."""
    torque_weight: float = 0.0
    """Per N m of the controller's torque itself, as R in the formula of Section 4.1."""


TABLE_4_1 = {'mpc1': TableRow(12, 3), 'mpc2': TableRow(16, 6), 'mpc3': TableRow(22, 4)}
BASIS = TABLE_4_1['mpc3']
"""Whose horizon and weights our own controllers take over."""
WEIGHTS = ('output_weight', 'final_weight', 'move_weight', 'torque_weight')
"""Fields of `TableRow` that `controllers.<name>` may give."""
PREDICTION_STEPS = 7
"""T_p = 0.07 s of MPC4."""
SLIP_WEIGHT, SLIP_ACCELERATION_WEIGHT = 1.0, math.sqrt(0.05)
"""Of w_d per rad/s and of dw_d/dt per rad/s^2: roots, as (4.1) does not square Q = (1, 0.05)."""
DEMAND_WEIGHT = 0.14
"""Per N m that C_m is away from the demand; docs/mpc4.md has the argument."""


def thesis_settings(row: TableRow, *, preview: bool = False) -> MpcSettings:
    """Return what the row means; docs/mpc.md gives the other readings of Q and R."""
    weight, final_weight = rpm_from_rad_s(row.output_weight), rpm_from_rad_s(row.final_weight)
    return MpcSettings(
        prediction_steps=row.prediction_steps,
        control_steps=row.control_steps,
        outputs=(OutputTerms(SLIP_SPEED, weight, final_weight),),
        inputs=(InputTerms(row.move_weight, row.torque_weight),),
        preview=preview,
    )


def mpc4_settings(
    slip_acceleration_weight: float = SLIP_ACCELERATION_WEIGHT,
    demand_weight: float = DEMAND_WEIGHT,
) -> MpcSettings:
    """Return what Section 4.3 means; R = P = 0 and inputs are constant over the horizon."""
    return MpcSettings(
        prediction_steps=PREDICTION_STEPS,
        control_steps=1,
        outputs=(
            OutputTerms(SLIP_SPEED, SLIP_WEIGHT),
            OutputTerms(SLIP_ACCELERATION, slip_acceleration_weight),
        ),
        inputs=(InputTerms(), InputTerms(target_weight=demand_weight)),
        preview=False,
        along_tangent=True,
    )


def default_torsion_weight(total_ratio: float) -> float:
    """
    Return the weight per rpm of w_sr that prices it like slip.

    w_sr is a speed at the wheels; at the primary shaft, where slip is measured, it is
    `total_ratio` times as large, and there 1 rpm of either costs the same.
    """
    return BASIS.output_weight * total_ratio


@dataclass(frozen=True)
class SlipCost:
    """A row of Table 4.1 with the weights that `keys` lets a scenario change."""

    row: TableRow = BASIS
    preview: bool = True
    keys: tuple[str, ...] = ()

    def settings(self, name: str, context: ControllerContext) -> MpcSettings:
        """Return what `controllers.<name>` makes of it; raise ParameterError for a bad weight."""
        weights: dict[str, Any] = {
            key: number_option(name, context.gains, key, getattr(self.row, key), at_least=0.0)
            for key in self.keys
        }
        return thesis_settings(replace(self.row, **weights), preview=self.preview)


@dataclass(frozen=True)
class TorsionCost:
    """`BASIS` with preview, and w_sr as a second output."""

    keys: ClassVar = ('torsion_weight',)

    def settings(self, name: str, context: ControllerContext) -> MpcSettings:
        """Return what `controllers.<name>` makes of it; raise ParameterError for a bad weight."""
        default = default_torsion_weight(context.settings.scenario.driveline.total_ratio)
        weight = number_option(name, context.gains, *self.keys, default, at_least=0.0)
        settings = thesis_settings(BASIS, preview=True)
        torsion = OutputTerms(TORSION_SPEED, rpm_from_rad_s(weight))
        return replace(settings, outputs=(*settings.outputs, torsion))


@dataclass(frozen=True)
class TwoInputCost:
    """That of MPC4: slip, its rate, and the deviation of C_m from the demand (Section 4.3)."""

    slip_acceleration_weight: float = SLIP_ACCELERATION_WEIGHT
    demand_weight: float = DEMAND_WEIGHT
    keys: ClassVar = ('slip_acceleration_weight', 'demand_weight')

    def settings(self, name: str, context: ControllerContext) -> MpcSettings:
        """Return what `controllers.<name>` makes of it; raise ParameterError for a bad weight."""
        given = {
            key: number_option(name, context.gains, key, getattr(self, key), at_least=0.0)
            for key in self.keys
        }
        return mpc4_settings(**given)
