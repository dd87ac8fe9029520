"""The predictive controllers by their names in the registry: what each is composed of."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from ddct_controllers.interface import ControllerContext
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.costs import TABLE_4_1, WEIGHTS, SlipCost, TorsionCost, TwoInputCost
from ddct_controllers.mpc.estimate.wear_model import WearNoise
from ddct_controllers.mpc.estimators import DisturbanceObserver, Filter, WearEstimate
from ddct_controllers.mpc.knowledge import AS_DRAWN, FULL, KEYS
from ddct_controllers.mpc.options import with_options


@dataclass(frozen=True)
class Variant:
    """A cost, and a model with its observer; the program follows from them."""

    cost: SlipCost | TorsionCost | TwoInputCost
    estimate: Filter | DisturbanceObserver | WearEstimate
    commands_engine: bool = False


VARIANTS = {
    **{
        name: Variant(SlipCost(row, preview=False, keys=WEIGHTS), Filter(AS_DRAWN, KEYS))
        for name, row in TABLE_4_1.items()
    },
    'mpc4': Variant(TwoInputCost(), Filter(FULL), commands_engine=True),
    'mpc_preview': Variant(SlipCost(keys=WEIGHTS), Filter(FULL, KEYS)),
    'mpc_offset_free': Variant(SlipCost(), DisturbanceObserver()),
    'mpc_torsion': Variant(TorsionCost(), DisturbanceObserver()),
    'mpc_wear': Variant(SlipCost(), WearEstimate(WearNoise())),
    # An error of the slip then decays with a time constant of 0.11 s, and C_m returns to the
    # demand with one of 0.8 s, far slower. With a gain beyond its bounds an estimated error of
    # C_f would make this loop oscillate.
    'mpc4_wear': Variant(
        TwoInputCost(slip_acceleration_weight=0.05, demand_weight=0.05),
        WearEstimate(WearNoise(clutch_drift_n_m=0.0)),
        commands_engine=True,
    ),
}
"""The thesis's first."""


def make_mpc(name: str, context: ControllerContext) -> MpcController:
    """Build a variant; raise ParameterError for an option that it does not take."""
    variant = VARIANTS[name]
    cost, estimate = variant.cost, variant.estimate
    settings = cost.settings(name, context)
    settings = with_options(name, settings, context.gains, (*cost.keys, *estimate.keys))
    model, observer = estimate.parts(name, context)
    authority = context.settings.scenario.engine_authority if variant.commands_engine else None
    return MpcController(model, observer, settings, authority)


PREDICTIVE: dict[str, Callable[[ControllerContext], MpcController]] = {
    name: partial(make_mpc, name) for name in VARIANTS
}
"""Factories."""
