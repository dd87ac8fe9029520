"""MPC4 of the thesis, with C_m as a second input (Section 4.3)."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from ddct_controllers.interface import ControllerContext
from ddct_controllers.mpc.build import make_observer
from ddct_controllers.mpc.model.transmission_model import (
    SLIP_ACCELERATION,
    SLIP_SPEED,
    transmission_model,
)
from ddct_controllers.mpc.options import number_option, with_options
from ddct_controllers.mpc.program.settings import InputTerms, MpcSettings, OutputTerms
from ddct_controllers.mpc.two_input_mpc import TwoInputController

NAME = 'mpc4'
PREDICTION_STEPS = 7
"""T_p = 0.07 s."""
SLIP_WEIGHT, SLIP_ACCELERATION_WEIGHT = 1.0, math.sqrt(0.05)
"""Of w_d per rad/s and of dw_d/dt per rad/s^2: roots, as (4.1) does not square Q = (1, 0.05)."""
DEMAND_WEIGHT = 0.14
"""Per N m that C_m is away from the demand; docs/mpc4.md has the argument."""


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


def mpc4_options(
    name: str, settings: MpcSettings, options: Mapping[str, Any], others: Sequence[str] = ()
) -> MpcSettings:
    """
    Return `settings` changed by the scenario's section of a controller with MPC4's cost.

    `others` are further keys of this controller; it reads them itself.
    """
    slip, acceleration = settings.outputs
    clutch, engine = settings.inputs
    own = {
        'slip_acceleration_weight': acceleration.weight,
        'demand_weight': engine.target_weight,
    }
    given = {
        key: number_option(name, options, key, default, at_least=0.0)
        for key, default in own.items()
    }
    acceleration = replace(acceleration, weight=given['slip_acceleration_weight'])
    engine = replace(engine, target_weight=given['demand_weight'])
    settings = replace(settings, outputs=(slip, acceleration), inputs=(clutch, engine))
    return with_options(name, settings, options, (*own, *others))


def make_mpc4(context: ControllerContext) -> TwoInputController:
    """Build `mpc4`; raise ParameterError for a key that it does not take."""
    scenario = context.settings.scenario
    settings = mpc4_options(NAME, mpc4_settings(), context.gains)
    model = transmission_model(scenario.driveline)
    observer = make_observer(context.settings, model)
    return TwoInputController(model, observer, settings, scenario.engine_authority)
