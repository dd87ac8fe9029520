"""The slip reference that a run's scenario and architecture ask for."""

from ddct_plant.base.timebase import PERIOD_S, steps_in
from ddct_plant.scenario.scenario import ENGINE_SPEED_TARGET, PROFILE
from ddct_plant.scenario.settings import RunSettings
from ddct_reference.descent import (
    CrfRamp,
    Descent,
    PolynomialDescent,
    ProfileDescent,
    TanhDescent,
)
from ddct_reference.engine_speed_target import EngineSpeedTarget
from ddct_reference.nominal_slip import nominal_slip
from ddct_reference.slip_reference import FollowingReference, SlipReference, StoredReference


def make_reference(settings: RunSettings, preview_steps: int = 0) -> SlipReference:
    """
    Build the reference of a run, which looks `preview_steps` periods ahead.

    `detailed` follows the slip speed until control starts, and starts from the one measured then.
    The other architectures have a stored function of time, that of the nominal detailed run.
    """
    scenario = settings.scenario
    if settings.reference_shape == ENGINE_SPEED_TARGET:
        return EngineSpeedTarget(
            scenario.engine_speed_reference,
            scenario.reference.slope_rad_s2,
            scenario.control_start_step,
            preview_steps,
        )
    descent = make_descent(settings)
    if settings.detailed:
        return FollowingReference(descent, scenario.control_start_step, preview_steps)
    return StoredReference(descent, nominal_slip(scenario), preview_steps)


def make_descent(settings: RunSettings) -> Descent:
    """Return how the reference of a run descends, which is not `engine_speed_target`."""
    reference = settings.scenario.reference
    if settings.reference_shape == 'ramp':
        return CrfRamp(reference.slope_rad_s2)
    if settings.reference_shape == PROFILE:
        scenario = settings.scenario
        return ProfileDescent(scenario.slip_reference, scenario.control_start_s)
    shapes = {'tanh': TanhDescent, 'polynomial': PolynomialDescent}
    end_step = steps_in('reference.reference_end_s', reference.reference_end_s)
    return shapes[settings.reference_shape](
        (end_step - settings.scenario.control_start_step) * PERIOD_S
    )
