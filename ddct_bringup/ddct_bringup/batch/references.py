"""The slip references of many runs: `SlipReference` over columns, without preview."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.batch.columns import distinct
from ddct_bringup.batch.plants import Plants
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.actuator import ActuatorParameters
from ddct_plant.scenario.scenario import PROFILE
from ddct_plant.scenario.settings import RunSettings
from ddct_reference.factory import make_descent

RAMP = 'ramp'


def reference_kind(settings: RunSettings) -> str:
    """Return what runs must have in common for one `References`."""
    shape = settings.reference_shape
    return shape if shape in (RAMP, PROFILE) else 'timed'


class References:
    """R references of one kind, architecture and control start."""

    def __init__(self, runs: Sequence[RunSettings], steps: int) -> None:
        """Know what there is to know of them up to step `steps`."""
        self._start = runs[0].scenario.control_start_step
        self._stored = None if runs[0].detailed else _nominal_slips(runs, self._start)
        self._start_value = np.zeros(len(runs)) if self._stored is None else self._stored[-1]
        self._kind = reference_kind(runs[0])
        periods = np.arange(max(steps - self._start + 1, 0))
        if self._kind == RAMP:
            self._slope = np.array([run.scenario.reference.slope_rad_s2 for run in runs])
        elif self._kind == PROFILE:
            start_s = runs[0].scenario.control_start_s
            times = start_s + periods * PERIOD_S
            self._table = np.stack(
                [run.scenario.slip_reference.over(times) for run in runs], axis=-1
            )
        else:
            self._table = _timed(runs, periods)

    def at(self, step: int, slip_speed: np.ndarray) -> np.ndarray:
        """Return the references in rad/s at step k, (R,), for w_d of this step."""
        if step < self._start:
            return slip_speed if self._stored is None else self._stored[step]
        if step == self._start and self._stored is None:
            self._start_value = slip_speed
        since = step - self._start
        if self._kind == RAMP:
            size = np.abs(self._start_value) - self._slope * (since * PERIOD_S)
            return np.where(size <= 0.0, 0.0, np.copysign(size, self._start_value))
        if self._kind == PROFILE:
            return self._table[since]
        return self._start_value * self._table[since]


def _timed(runs: Sequence[RunSettings], periods: np.ndarray) -> np.ndarray:
    """Return the share of its start that is left of each descent, (periods, R)."""
    first, places = distinct((run.reference_shape, run.scenario.reference) for run in runs)
    descents = [make_descent(runs[index]) for index in first]
    shares = [[descent.at(1.0, since * PERIOD_S)[0] for since in periods] for descent in descents]
    return np.take(np.array(shares).T, places, axis=-1)


def _nominal_slips(runs: Sequence[RunSettings], control_start: int) -> np.ndarray:
    """Return what `nominal_slip` does of each run, (control_start + 1, R)."""
    nominal = [RunSettings(run.scenario, architecture='detailed') for run in runs]
    plants = Plants(nominal, [ActuatorParameters()] * len(runs), control_start)
    slips = [plants.outputs().slip_speed]
    for step in range(control_start):
        load_torque = plants.load_torque(step)
        plants.advance(step, load_torque, plants.static_torque(step, load_torque))
        slips.append(plants.outputs().slip_speed)
    return np.array(slips)
