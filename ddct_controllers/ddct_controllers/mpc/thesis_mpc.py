"""MPC1, MPC2 and MPC3 of the thesis (Section 4.2, Table 4.1), and what we make of MPC3."""

from dataclasses import dataclass, replace
from typing import Any

from ddct_controllers.interface import ControllerContext
from ddct_controllers.mpc.build import make_observer
from ddct_controllers.mpc.estimate.observer import Observer
from ddct_controllers.mpc.estimate.unit_noise import unit_noise_gain
from ddct_controllers.mpc.knowledge import AS_DRAWN, FULL, KEYS, Knowledge, with_knowledge
from ddct_controllers.mpc.model.transmission_model import (
    SLIP_SPEED,
    TransmissionModel,
    transmission_model,
)
from ddct_controllers.mpc.options import number_option, with_options
from ddct_controllers.mpc.predictive_controller import PredictiveController
from ddct_controllers.mpc.program.settings import InputTerms, MpcSettings, OutputTerms
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.scenario.settings import RunSettings


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
PREVIEW = 'mpc_preview'
WEIGHTS = ('output_weight', 'final_weight', 'move_weight', 'torque_weight')
"""Fields of `TableRow` that `controllers.<name>` may give."""


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


def make_thesis_mpc(name: str, context: ControllerContext) -> PredictiveController:
    """Build `mpc1`, `mpc2` or `mpc3`; raise ParameterError for a key that it does not take."""
    return _make(name, TABLE_4_1[name], AS_DRAWN, context, preview=False)


def make_preview_mpc(context: ControllerContext) -> PredictiveController:
    """Build `mpc_preview`, MPC3 that is told more; raise ParameterError for a bad key."""
    return _make(PREVIEW, BASIS, FULL, context, preview=True)


def slip_mpc(
    run: RunSettings,
    settings: MpcSettings,
    knowledge: Knowledge,
    model: TransmissionModel | None = None,
    *,
    noise_rpm: float = 1.0,
) -> PredictiveController:
    """
    Put model, estimator and program together.

    `model` takes the place of the one that is known of; `noise_rpm` is that of w_d where it is
    measured alone.
    """
    if model is None:
        model = transmission_model(run.scenario.driveline, delay=knowledge.delay_in_model)
    known = model if knowledge.load_known else model.without_load()
    if knowledge.measured == 'slip':
        observer = Observer(known, unit_noise_gain(known, noise_rpm), start=None)
    else:
        observer = make_observer(run, model, load_known=knowledge.load_known)
    return PredictiveController(known, observer, settings)


def _make(
    name: str, row: TableRow, knowledge: Knowledge, context: ControllerContext, *, preview: bool
) -> PredictiveController:
    options = context.gains
    weights: dict[str, Any] = {
        key: number_option(name, options, key, getattr(row, key), at_least=0.0) for key in WEIGHTS
    }
    settings = thesis_settings(replace(row, **weights), preview=preview)
    settings = with_options(name, settings, options, (*WEIGHTS, *KEYS))
    return slip_mpc(context.settings, settings, with_knowledge(name, knowledge, options))
