"""The closed loops of many runs: `ClosedLoop` over columns."""

from collections.abc import Callable, Sequence

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.batch.columns import distinct
from ddct_bringup.batch.filters import Filters
from ddct_bringup.batch.plants import Plants
from ddct_bringup.batch.references import References
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.linear.lti import StateSpace
from ddct_plant.scenario.settings import RunSettings

_ROWS = 13
"""Signals per step, each joint's for itself."""
OpenLoops = Callable[[int, np.ndarray], np.ndarray]
"""Returns the torques in N m, (R,), that do not depend on the slip, for step and C_load."""


def simulate_batch(runs: Sequence[RunSettings], feedback: Sequence[StateSpace]) -> Trajectory:
    """
    Return the signals of `run_headless` that scores need, each with the runs as its first axis.

    `feedback` is the `linear_model` of each controller. All runs are as long, of one architecture,
    equilibrium, control start and kind of reference; all models are of one order.
    """
    steps, start = runs[0].scenario.steps, runs[0].scenario.control_start_step
    plants = Plants(runs, [run.scenario.actuator for run in runs], steps)
    references = References(runs, steps)
    open_loop, filters = _open_loops(runs, plants), Filters(feedback)
    feedback_start = start if runs[0].detailed else 0
    record = np.empty((steps + 1, _ROWS, len(runs)))
    for step in range(steps + 1):
        now = plants.outputs()
        load = plants.load_torque(step)
        reference = references.at(step, now.slip_speed)
        request = open_loop(step, load)
        if step >= feedback_start:
            request = request + filters.update(rpm_from_rad_s(reference - now.slip_speed))
        record[step] = [
            *now.joint_speed,
            *now.joint_effort,
            *(now.slip_speed, now.vehicle_accel, load, reference, request),
        ]
        plants.advance(step, load, request)
    return _trajectory(record)


def _open_loops(runs: Sequence[RunSettings], plants: Plants) -> OpenLoops:
    """Return what `make_architecture` does of each run."""
    if runs[0].detailed:
        return plants.static_torque
    if runs[0].architecture == 'base':
        return lambda step, load: np.zeros(len(runs))
    # Only here: the other architectures need not wait for the imports of the design.
    from ddct_controllers.design.feedforward import design_feedforward, state_at_rest

    drivelines = [run.scenario.driveline for run in runs]
    first, places = distinct(drivelines)
    designed = [design_feedforward(drivelines[index]) for index in first]
    models = [designed[place] for place in places]
    torques = plants.engine_torque
    at_rest = [state_at_rest(*each) for each in zip(models, torques[0], strict=True)]
    filters = Filters(models, np.stack(at_rest, axis=-1))
    return lambda step, load: filters.update(torques[step], load)


def _trajectory(record: np.ndarray) -> Trajectory:
    """Return the signals of rows (N+1, rows, R)."""
    # Each run's samples side by side, in which metrics are summed up.
    signals = np.empty((record.shape[1], record.shape[2], record.shape[0]))
    for index in range(len(signals)):
        signals[index] = record[:, index].T
    return Trajectory(
        {
            'joint_speed': np.moveaxis(signals[:4], 0, -1),
            'joint_effort': np.moveaxis(signals[4:8], 0, -1),
            'slip_speed': signals[8],
            'vehicle_accel': signals[9],
            'load_torque': signals[10],
            'slip_reference': signals[11, :, :, np.newaxis],
            'torque_request': signals[12],
        }
    )
