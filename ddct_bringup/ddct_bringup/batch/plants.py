"""The linear plants of many runs: engine, load, actuator, clutch and driveline."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.columns import distinct, product, stacked
from ddct_plant.base.timebase import STEPS_PER_S, SUBSTEPS
from ddct_plant.models.actuator import ActuatorParameters, at_rest, lifted
from ddct_plant.models.driveline import driveline_outputs, step_matrix
from ddct_plant.models.load import resisting_torque
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.plant import initial_state, make_load
from ddct_plant.scenario.settings import RunSettings

_STATES = slice(0, 4)
_ENGINE, _LOAD = 4, 5
_ACTUATOR = slice(6, 12)
"""Rows of what a step takes: states, C_m, C_load, and what `Actuators` has as values."""
_LAG_STATES = slice(0, 4)
_EARLIER, _LATER = 4, 5
"""Rows of what an actuator takes: G_a's states, and the two requests in effect in a period."""


class Plants:
    """
    `WholePlant` for R runs of one equilibrium, with a linear clutch and an engine without limits.

    Angles are left out: nothing that is scored depends on them.
    """

    def __init__(
        self, runs: Sequence[RunSettings], actuators: Sequence[ActuatorParameters], steps: int
    ) -> None:
        """Start in the initial states; engine and road are known up to step `steps`."""
        scenarios = [run.scenario for run in runs]
        self._driveline = stacked([scenario.driveline for scenario in scenarios])
        self._static: Any = StaticTorque(self._driveline, scenarios[0].equilibrium)
        start = stacked([initial_state(run) for run in runs])
        self._wear = np.array([run.wear_gain for run in runs])
        loads = [make_load(run) for run in runs]
        self._wheel_radius: Any = np.array([load.wheel_radius for load in loads])
        self._drag = np.array([load.drag for load in loads])
        self._wind = np.array([load.wind for load in loads])
        times = np.arange(steps + 1) / STEPS_PER_S
        known = times if any(scenario.slope.given for scenario in scenarios) else times[:1]
        forces = np.stack([load.forces(known) for load in loads], axis=-1)
        self._forces = np.broadcast_to(forces, (steps + 1, len(runs)))
        engines = [scenario.engine for scenario in scenarios]
        first, places = distinct(engines)
        profiles = [
            np.interp(times, engines[index].time_s, engines[index].torque_n_m) for index in first
        ]
        self.engine_torque = np.stack([profiles[place] for place in places], axis=-1)
        """C_m in N m at every step, (N+1, R), what `Engine.demand` returns."""
        self._actuators = Actuators(actuators, start.torque_request, steps + 1)
        nodes = self._actuators.nodes * self._wear[:, np.newaxis, np.newaxis]
        self._step = _step_matrices([each.driveline for each in scenarios], nodes)
        self._values = np.zeros((_ACTUATOR.stop, len(runs)))
        speeds = start.engine_speed, start.shaft_speed, start.wheel_speed
        self._values[_STATES] = *speeds, start.twist
        self._torques: Any = (start.engine_torque, start.clutch_torque, start.load_torque)

    def outputs(self) -> Any:
        """Return `DrivelineOutputs` at the present stamp, each value (R,) and without angles."""
        states: Any = self._values[_STATES]
        return driveline_outputs(self._driveline, self._wheel_radius, states, self._torques)

    def load_torque(self, step: int) -> np.ndarray:
        """Return C_load in N m, (R,), at step `step` in the present state."""
        vehicle_speed = self._wheel_radius * self._values[2]
        return resisting_torque(
            self._drag, self._wind, self._forces[step], self._wheel_radius, vehicle_speed
        )

    def static_torque(self, step: int, load_torque: np.ndarray) -> np.ndarray:
        """Return C_fOL in N m, (R,), for C_load in N m in the present state."""
        engine_speed, shaft_speed = self._values[:2]
        return self._static.torque(
            self.engine_torque[step], load_torque, engine_speed, shaft_speed
        )

    def advance(self, step: int, load_torque: np.ndarray, request: np.ndarray) -> None:
        """Step by 10 ms with held C_m and C_load, (R,) in N m, and what the clutch is asked."""
        values, engine_torque = self._values, self.engine_torque[step]
        self._actuators.ask(step, request)
        values[_ENGINE], values[_LOAD] = engine_torque, load_torque
        values[_ACTUATOR] = self._actuators.values
        values[_STATES] = product(self._step, values)
        self._torques = (engine_torque, self._wear * self._actuators.advance(), load_torque)


def _step_matrices(drivelines: Sequence[DrivelineParameters], nodes: np.ndarray) -> np.ndarray:
    """
    Return the (4, 12, R) map to the next states, actuator and clutch included.

    `nodes` (R, 11, 6) give C_f within a period by the values of the actuators.
    """
    first, places = distinct(drivelines)
    steps = step_matrix(stacked([drivelines[index] for index in first]), angles=False)[places]
    # Up to there it takes the four states, C_m and C_load; what follows are the nodes of C_f.
    matrices = np.concatenate([steps[:, :, :6], steps[:, :, 6:] @ nodes], axis=-1)
    return np.ascontiguousarray(matrices.transpose(1, 2, 0))


class Actuators:
    """
    `Actuator` over columns, R of them.

    Where a delay is whole periods its earlier request has no effect.
    """

    def __init__(
        self, parameters: Sequence[ActuatorParameters], requests: np.ndarray, steps: int
    ) -> None:
        """Start at rest on requests, (R,) in N m; they last `steps` periods."""
        first, places = distinct(parameters)
        periods = np.array([each.delay_substeps // SUBSTEPS for each in parameters])
        made = [_actuator_matrices(parameters[index]) for index in first]
        updates, nodes, rest = (np.stack(each) for each in zip(*made, strict=True))
        self.nodes = nodes[places]
        """(R, 11, 6): the torque at 0, 1, ..., 10 ms by `values`."""
        rows = np.concatenate([updates, nodes[:, -1:]], axis=1).transpose(1, 2, 0)
        self._rows = rows[..., 0] if len(first) == 1 else np.take(rows, places, axis=-1)
        delayed = np.maximum(requests, 0.0)
        self.values = np.zeros((_LATER + 1, len(parameters)))
        """(6, R): states, and once `ask` has been called the requests in effect."""
        self.values[_LAG_STATES] = np.take(rest.T, places, axis=-1) * delayed
        self._before = int(periods.max()) + 1
        self._asked = np.empty((self._before + steps, len(parameters)))
        self._asked[: self._before] = delayed
        alike = bool((periods == periods[0]).all())
        self._later = self._before - (int(periods[0]) if alike else periods)
        self._columns = slice(None) if alike else np.arange(len(parameters))

    def ask(self, step: int, requests: np.ndarray) -> None:
        """Take the requests of step k in, (R,) in N m, cut off below zero."""
        np.maximum(requests, 0.0, out=self._asked[self._before + step])
        later = self._later + step
        self.values[_EARLIER] = self._asked[later - 1, self._columns]
        self.values[_LATER] = self._asked[later, self._columns]

    def advance(self) -> np.ndarray:
        """Go to the end of the period; return the torque there, (R,) in N m."""
        followed = product(self._rows, self.values)
        self.values[_LAG_STATES] = followed[:-1]
        return followed[-1]


def _actuator_matrices(
    parameters: ActuatorParameters,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the (4, 6) next state, the (11, 6) nodes and the state of rest for 1 N m."""
    model, late = parameters.dynamics(), parameters.delay_substeps % SUBSTEPS
    update, nodes = lifted(model, late)
    if not late:
        update, nodes = (np.insert(each, _EARLIER, 0.0, axis=1) for each in (update, nodes))
    return update, nodes, at_rest(model, 1.0)
