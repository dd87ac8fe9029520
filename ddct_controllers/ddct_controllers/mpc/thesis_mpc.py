"""MPC1, MPC2 and MPC3 of the thesis (Section 4.2, Table 4.1)."""

from dataclasses import dataclass

from ddct_controllers.interface import ControllerContext
from ddct_controllers.mpc.build import make_observer
from ddct_controllers.mpc.options import with_options
from ddct_controllers.mpc.predictive_controller import PredictiveController
from ddct_controllers.mpc.settings import InputTerms, MpcSettings, OutputTerms
from ddct_controllers.mpc.transmission_model import SLIP_SPEED, transmission_model
from ddct_plant.units import rpm_from_rad_s


@dataclass(frozen=True)
class TableRow:
    """One row of Table 4.1."""

    prediction_steps: int
    """T_p in periods."""
    control_steps: int
    """T_c in periods."""
    output_weight: float = 0.26
    """Q, taken per rpm."""
    move_weight: float = 0.39
    """R, per N m."""


TABLE_4_1 = {'mpc1': TableRow(12, 3), 'mpc2': TableRow(16, 6), 'mpc3': TableRow(22, 4)}


def thesis_settings(row: TableRow) -> MpcSettings:
    """Return what the row means; docs/mpc.md gives the other readings of Q and R."""
    return MpcSettings(
        prediction_steps=row.prediction_steps,
        control_steps=row.control_steps,
        outputs=(OutputTerms(SLIP_SPEED, rpm_from_rad_s(row.output_weight)),),
        inputs=(InputTerms(move_weight=row.move_weight),),
    )


def make_thesis_mpc(name: str, context: ControllerContext) -> PredictiveController:
    """Build `mpc1`, `mpc2` or `mpc3`; raise ParameterError for a key that it does not take."""
    model = transmission_model(context.settings.scenario.driveline)
    settings = with_options(name, thesis_settings(TABLE_4_1[name]), context.gains)
    return PredictiveController(model, make_observer(context.settings, model), settings)
