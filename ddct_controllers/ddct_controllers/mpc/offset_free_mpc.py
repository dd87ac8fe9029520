"""`mpc_preview` with a disturbance observer, and the same with w_sr as a second output."""

import dataclasses

from ddct_controllers.interface import ControllerContext
from ddct_controllers.mpc.build import make_observer
from ddct_controllers.mpc.estimate.disturbances import (
    CLUTCH_DRIFT_N_M,
    LOAD_DRIFT_N_M,
    offset_free_model,
    offset_free_noise,
)
from ddct_controllers.mpc.model.transmission_model import TORSION_SPEED
from ddct_controllers.mpc.options import number_option, with_options
from ddct_controllers.mpc.predictive_controller import PredictiveController
from ddct_controllers.mpc.program.settings import MpcSettings, OutputTerms
from ddct_controllers.mpc.thesis_mpc import BASIS, thesis_settings
from ddct_plant.base.units import rpm_from_rad_s

_DRIFTS = {'clutch_drift_n_m': CLUTCH_DRIFT_N_M, 'load_drift_n_m': LOAD_DRIFT_N_M}
_TORSION_WEIGHT = 'torsion_weight'


def make_offset_free_mpc(context: ControllerContext) -> PredictiveController:
    """Build `mpc_offset_free`; raise ParameterError for an option that it does not take."""
    return _build('mpc_offset_free', context, thesis_settings(BASIS, preview=True))


def make_torsion_mpc(context: ControllerContext) -> PredictiveController:
    """Build `mpc_torsion`; raise ParameterError for an option that it does not take."""
    name = 'mpc_torsion'
    default = default_torsion_weight(context.settings.scenario.driveline.total_ratio)
    weight = number_option(name, context.gains, _TORSION_WEIGHT, default, at_least=0.0)
    settings = thesis_settings(BASIS, preview=True)
    torsion = OutputTerms(TORSION_SPEED, rpm_from_rad_s(weight))
    settings = dataclasses.replace(settings, outputs=(*settings.outputs, torsion))
    return _build(name, context, settings, own=(_TORSION_WEIGHT,))


def default_torsion_weight(total_ratio: float) -> float:
    """
    Return the weight per rpm of w_sr that prices it like slip.

    w_sr is a speed at the wheels; at the primary shaft, where slip is measured, it is
    `total_ratio` times as large, and there 1 rpm of either costs the same.
    """
    return BASIS.output_weight * total_ratio


def _build(
    name: str, context: ControllerContext, settings: MpcSettings, own: tuple[str, ...] = ()
) -> PredictiveController:
    options = context.gains
    settings = with_options(name, settings, options, (*own, *_DRIFTS))
    drifts = {
        key: number_option(name, options, key, default, above=0.0)
        for key, default in _DRIFTS.items()
    }
    model = offset_free_model(context.settings.scenario.driveline)
    observer = make_observer(context.settings, model, offset_free_noise(**drifts))
    return PredictiveController(model, observer, settings)
