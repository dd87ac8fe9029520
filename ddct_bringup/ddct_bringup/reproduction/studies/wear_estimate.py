"""How fast and how well `mpc_wear` knows the wear of the clutch."""

import numpy as np

from ddct_bringup.reproduction.runs.runs import THESIS_SCENARIO
from ddct_bringup.reproduction.studies.disturbed_run import NoisySpeeds, slip_after_load_step
from ddct_bringup.reproduction.studies.study import Study
from ddct_bringup.reproduction.studies.wear import LOAD_STEP_N_M, LOAD_STEP_S, WEAR_GAINS
from ddct_controllers.interface import ControllerContext
from ddct_controllers.mpc.estimate.gains import NoiseLevels
from ddct_controllers.mpc.variants import PREDICTIVE
from ddct_plant.base.timebase import PERIOD_S, steps_in
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.scenario.settings import RunSettings

SEED = 4
CLOSE = 0.02
"""How near the true gain counts as known."""


def wear_estimate() -> Study:
    """Run `mpc_wear` with exact and with noisy speeds, with a load step."""
    noise = NoiseLevels().speed_rad_s
    return Study(
        title='Estimate of K_usura in the thesis scenario, with a load step',
        headers=(
            'K_usura',
            'noise on speeds rad/s',
            f'within {CLOSE:g} from s',
            'rms error after 0.6 s',
            'largest error after 0.6 s',
            'w_d at the end rpm',
        ),
        rows=[_row(gain, level) for level in (0.0, noise) for gain in WEAR_GAINS],
        remarks=(
            f'The load step is {LOAD_STEP_N_M:g} N m at the wheels at {LOAD_STEP_S:g} s.',
            'Torque flows from about 0.05 s on; the noise is the standard deviation that the '
            'filter assumes, drawn with a fixed seed.',
        ),
    )


def estimates(settings: RunSettings, noise_rad_s: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the estimate of K_usura and w_d in rad/s, (steps + 1,), with the load step."""
    controller = PREDICTIVE['mpc_wear'](ControllerContext(settings, {}))
    gains: list[float] = []
    slip = slip_after_load_step(
        settings,
        NoisySpeeds(controller, noise_rad_s, SEED),
        LOAD_STEP_N_M,
        steps_in('load step', LOAD_STEP_S),
        each_step=lambda: gains.append(controller.observer.wear_gain),
    )
    return np.array(gains), slip


def _row(wear_gain: float, noise_rad_s: float) -> tuple[str, ...]:
    settings = RunSettings(THESIS_SCENARIO, wear_gain=wear_gain)
    gains, slip = estimates(settings, noise_rad_s)
    error = gains - wear_gain
    controlled = error[settings.scenario.control_start_step :]
    outside = np.flatnonzero(np.abs(error) > CLOSE)
    return (
        f'{wear_gain:g}',
        f'{noise_rad_s:g}',
        f'{(outside[-1] + 1 if outside.size else 0) * PERIOD_S:.2f}',
        f'{np.sqrt(np.mean(controlled**2)):.4f}',
        f'{np.abs(controlled).max():.4f}',
        f'{rpm_from_rad_s(slip[-1]):z.2f}',
    )
