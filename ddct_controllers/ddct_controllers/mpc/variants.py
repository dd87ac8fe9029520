"""The predictive controllers by their names in the registry: what each is composed of."""

from ddct_controllers.interface import ControllerContext, ControllerSpec
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.costs import TABLE_4_1, SlipCost, TorsionCost, TwoInputCost
from ddct_controllers.mpc.estimators import DisturbanceObserver, Filter, WearEstimate
from ddct_controllers.mpc.knowledge import AS_DRAWN, FULL
from ddct_controllers.mpc.options import program_options, with_options
from ddct_plant.models.parameters import DrivelineParameters

Predictive = ControllerSpec[MpcController]


def predictive(
    name: str,
    cost: SlipCost | TorsionCost | TwoInputCost,
    estimate: Filter | DisturbanceObserver | WearEstimate,
    *,
    commands_engine: bool = False,
) -> Predictive:
    """Compose a controller: the program follows from the cost, and the model of the estimate."""

    def make(context: ControllerContext) -> MpcController:
        values, run = context.gains, context.settings
        settings = with_options(cost.settings(values, run.scenario.driveline), values)
        model, observer = estimate.parts(values, run)
        authority = run.scenario.engine_authority if commands_engine else None
        return MpcController(model, observer, settings, authority)

    program = program_options(cost.settings({}, DrivelineParameters()))
    return ControllerSpec(name, make, {**cost.options, **estimate.options, **program})


PREDICTIVE: dict[str, Predictive] = {
    spec.name: spec
    for spec in (
        *(
            predictive(
                name,
                SlipCost(row, preview=False, changeable=True),
                Filter(AS_DRAWN, changeable=True),
            )
            for name, row in TABLE_4_1.items()
        ),
        predictive('mpc4', TwoInputCost(), Filter(FULL), commands_engine=True),
        predictive('mpc_preview', SlipCost(changeable=True), Filter(FULL, changeable=True)),
        predictive('mpc_offset_free', SlipCost(), DisturbanceObserver()),
        predictive('mpc_torsion', TorsionCost(), DisturbanceObserver()),
        predictive('mpc_wear', SlipCost(), WearEstimate()),
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
"""The thesis's first."""
