# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Closed loops of many runs as columns, the counterpart of `ClosedLoop`, and their references."""

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from itertools import accumulate

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.batch.plants import Plants
from ddct_bringup.batch.stacks import Filters, distinct
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.linear.lti import StateSpace
from ddct_plant.scenario.control import PROFILE
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from ddct_plant.signals.topics import all_signals
from ddct_reference.factory import make_descent

RAMP = 'ramp'
_SIGNALS = (
    *('joint_speed', 'joint_effort', 'slip_speed', 'vehicle_accel'),
    *('load_torque', 'slip_reference', 'torque_request', 'torque_demand', 'engine_torque'),
)
"""Signals that are recorded at each step, in the order of the values of a step."""
OpenLoops = Callable[[int, np.ndarray], np.ndarray]
"""Function of step and known C_load that returns the open-loop torques in N m, (R,)."""


def simulate_batch(runs: Sequence[RunSettings], feedback: Sequence[StateSpace]) -> Trajectory:
    """
    Return the signals of `run_headless` that scores need, with the runs as their first axis.

    `feedback` is the `linear_model` of each controller. All runs have one length, architecture,
    equilibrium, control start and kind of reference, and their controllers know one delay of the
    actuator; all models have one order.
    """
    known = [run.known for run in runs]
    steps, start = runs[0].scenario.steps, known[0].scenario.control_start_step
    plants = Plants(runs, steps)
    references = References(known, steps)
    open_loop, filters = _open_loops(known, plants), Filters(feedback)
    feedback_start = start if runs[0].detailed else 0
    rows = _rows()
    record = np.empty((steps + 1, max(each.stop for each in rows.values()), len(runs)))
    for step in range(steps + 1):
        now = plants.outputs()
        load = plants.load_torque(step)
        reference = references.at(step, now.slip_speed)
        request = open_loop(step, plants.known_load_torque(step))
        if step >= feedback_start:
            request = request + filters.update(rpm_from_rad_s(reference - now.slip_speed))
        record[step] = [
            *now.joint_speed,
            *now.joint_effort,
            *(now.slip_speed, now.vehicle_accel, load, reference, request),
            *(plants.engine_torque[step],) * 2,
        ]
        plants.advance(step, load, request)
    return _trajectory(record, rows)


def _open_loops(runs: Sequence[KnownSettings], plants: Plants) -> OpenLoops:
    """Return the open loops of runs, given by known settings, as `make_architecture` does."""
    if runs[0].detailed:
        return plants.static_torque
    if runs[0].architecture == 'base':
        return lambda step, load: np.zeros(len(runs))
    # Imported here, so that the other architectures do not wait for the imports of the design.
    from ddct_controllers.design.feedforward import design_feedforward, state_at_rest

    designed = cache(design_feedforward)
    scenarios = [run.scenario for run in runs]
    models = [designed(each.driveline, each.actuator) for each in scenarios]
    torques = plants.engine_torque
    at_rest = [state_at_rest(*each) for each in zip(models, torques[0], strict=True)]
    filters = Filters(models, np.stack(at_rest, axis=-1))
    return lambda step, load: filters.update(torques[step], load)


def _rows() -> dict[str, slice]:
    """Return by signal of `_SIGNALS` the rows of its values; a preview has its first value."""
    sizes = {signal.name: signal.size or 1 for signal in all_signals()}
    ends = list(accumulate((sizes[name] for name in _SIGNALS), initial=0))
    return {name: slice(*ends[at : at + 2]) for at, name in enumerate(_SIGNALS)}


def _trajectory(record: np.ndarray, rows: Mapping[str, slice]) -> Trajectory:
    """Return the trajectory of recorded values (N+1, rows, R)."""
    # The samples of each run are contiguous, so metrics are summed in the order of a single run.
    signals = np.empty((record.shape[1], record.shape[2], record.shape[0]))
    for index in range(len(signals)):
        signals[index] = record[:, index].T
    single = {signal.name for signal in all_signals() if signal.size == 1}
    return Trajectory(
        {
            name: signals[place.start] if name in single else np.moveaxis(signals[place], 0, -1)
            for name, place in rows.items()
        }
    )


def reference_kind(settings: KnownSettings) -> str:
    """Return the key that runs with one common `References` share."""
    shape = settings.reference_shape
    return shape if shape in (RAMP, PROFILE) else 'timed'


class References:
    """
    Slip references as columns, without preview.

    The R runs, given by their known settings, have one kind, architecture and start.
    """

    def __init__(self, runs: Sequence[KnownSettings], steps: int) -> None:
        """Compute everything that does not depend on the slip, up to step `steps`."""
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


def _timed(runs: Sequence[KnownSettings], periods: np.ndarray) -> np.ndarray:
    """Return the remaining share of the initial slip along each descent, (periods, R)."""
    first, places = distinct((run.reference_shape, run.scenario.reference) for run in runs)
    descents = [make_descent(runs[index]) for index in first]
    shares = [[descent.at(1.0, since * PERIOD_S)[0] for since in periods] for descent in descents]
    return np.take(np.array(shares).T, places, axis=-1)


def _nominal_slips(runs: Sequence[KnownSettings], control_start: int) -> np.ndarray:
    """Return the nominal slip of each run as `nominal_slip` does, (control_start + 1, R)."""
    nominal = [RunSettings(KnownSettings(run.scenario)) for run in runs]
    plants = Plants(nominal, control_start)
    slips = [plants.outputs().slip_speed]
    for step in range(control_start):
        load_torque = plants.load_torque(step)
        plants.advance(step, load_torque, plants.static_torque(step, load_torque))
        slips.append(plants.outputs().slip_speed)
    return np.array(slips)
