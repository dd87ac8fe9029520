# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The predictive controllers by their names in the registry, with cost and estimator of each."""

from collections.abc import Collection
from dataclasses import replace
from typing import Any

from ddct_controllers.interface import ControllerContext, ControllerSpec
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.costs import (
    PREDICTION_STEPS,
    PREVIEW,
    TABLE_4_1,
    TableRow,
    TorsionCost,
    TwoInputCost,
)
from ddct_controllers.mpc.estimators import (
    AS_DRAWN,
    FULL,
    DisturbanceObserver,
    ObserverInputs,
    WearEstimate,
)
from ddct_controllers.mpc.program.settings import program_options, with_options
from ddct_plant.base.options import Option, OptionGroup, with_values
from ddct_plant.models.parameters import DrivelineParameters

Predictive = ControllerSpec[MpcController[Any]]


def predictive(
    name: str,
    cost: TableRow | TorsionCost | TwoInputCost,
    estimate: ObserverInputs | DisturbanceObserver | WearEstimate,
    *,
    fixed: Collection[OptionGroup] = (),
    commands_engine: bool = False,
) -> Predictive:
    """
    Compose a controller: the program follows from the cost, and the model from the estimator.

    A scenario may change the options of horizon, limits and solver, and those of cost and
    estimator that are not `fixed`.
    """

    def make(context: ControllerContext) -> MpcController[Any]:
        values, run = context.gains, context.settings
        scenario = run.scenario
        chosen = with_values(cost, values).settings(
            scenario.controlled_driveline, scenario.actuator
        )
        model, observer = with_values(estimate, values).parts(run)
        authority = scenario.engine_authority if commands_engine else None
        return MpcController(model, observer, with_options(chosen, values), authority)

    options: dict[str, Option] = {}
    for group in (cost, estimate):
        if group not in fixed:
            options |= group.options
    options |= program_options(cost.settings(DrivelineParameters()))
    if isinstance(cost, TwoInputCost):
        options['prediction_steps'] = replace(
            options['prediction_steps'],
            default=None,
            otherwise=f'{PREDICTION_STEPS}, more where the actuator lags by more than as printed',
        )
    return ControllerSpec(name, make, options)


PREDICTIVE: dict[str, Predictive] = {
    spec.name: spec
    for spec in (
        *(predictive(name, row, AS_DRAWN) for name, row in TABLE_4_1.items()),
        predictive('mpc4', TwoInputCost(), FULL, fixed=[FULL], commands_engine=True),
        predictive('mpc_preview', PREVIEW, FULL),
        predictive('mpc_offset_free', PREVIEW, DisturbanceObserver(), fixed=[PREVIEW]),
        predictive('mpc_torsion', TorsionCost(), DisturbanceObserver()),
        predictive('mpc_wear', PREVIEW, WearEstimate(), fixed=[PREVIEW]),
        # An error of the slip then decays with a time constant of 0.11 s, and C_m returns to the
        # demand with one of 0.8 s, far slower. With a gain beyond its bounds an estimated error
        # of C_f would make this loop oscillate.
        predictive(
            'mpc4_wear',
            TwoInputCost(slip_acceleration_weight=0.05, demand_weight=0.05),
            WearEstimate(clutch_drift_n_m=0.0),
            commands_engine=True,
        ),
    )
}
"""Specifications of the predictive controllers by name, the thesis's first."""
