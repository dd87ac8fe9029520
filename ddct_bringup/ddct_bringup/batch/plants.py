# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Linear plants of many runs: engine, load, actuator, clutch and driveline."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.stacks import distinct, product, stacked
from ddct_plant.base.timebase import STEPS_PER_S, SUBSTEPS
from ddct_plant.models.actuator import ActuatorParameters, at_rest, lifted
from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.models.driveline_model import STATES
from ddct_plant.models.linear_driveline import step_matrix
from ddct_plant.models.load import resisting_torque
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.plant import make_load
from ddct_plant.scenario.settings import AnySettings, RunSettings

_STATES = slice(0, len(STATES))
_ENGINE, _LOAD = len(STATES), len(STATES) + 1
_ACTUATOR = slice(_LOAD + 1, _LOAD + 7)
"""Row indices of the input of a step: states, C_m, C_load, and `values` of `Actuators`."""
_NO_ANGLES = (math.nan,) * 3
_LAG_STATES = slice(0, 4)
_EARLIER, _LATER = 4, 5
"""Row indices of the input of an actuator: states of G_a, and both requests in a period."""


class Plants:
    """
    Plants of R runs as columns, the counterpart of `Plant`, and C_fOL of the known cars.

    All runs have one equilibrium, and their known settings one; a linear clutch and an engine
    without limits. Angles are left out: no score depends on them.
    """

    def __init__(self, runs: Sequence[RunSettings], steps: int) -> None:
        """Start in the initial states; profiles of engine and road extend to step `steps`."""
        scenarios = [run.scenario for run in runs]
        self._driveline = stacked([scenario.driveline for scenario in scenarios])
        known = [run.known for run in runs]
        self._static: Any = StaticTorque(
            stacked([run.scenario.driveline for run in known]), known[0].scenario.equilibrium
        )
        start = stacked([initial_state(run) for run in runs])
        self._wear = np.array([run.case.wear_gain for run in runs])
        self._loads, self._known_loads = Loads(runs, steps), Loads(known, steps)
        times = np.arange(steps + 1) / STEPS_PER_S
        engines = [scenario.demand for scenario in scenarios]
        first, places = distinct(engines)
        profiles = [engines[index].over(times) for index in first]
        self.engine_torque = np.stack([profiles[place] for place in places], axis=-1)
        """Engine torque C_m in N m at every step, (N+1, R), as `Engine.demand` returns it."""
        actuators = [scenario.actuator for scenario in scenarios]
        self._actuators = Actuators(actuators, start.sides[0].torque_request, steps + 1)
        nodes = self._actuators.nodes * self._wear[:, np.newaxis, np.newaxis]
        self._step = _step_matrices([each.driveline for each in scenarios], nodes)
        self._values = np.zeros((_ACTUATOR.stop, len(runs)))
        self._values[_STATES] = start.states
        self._torques: Any = (start.engine_torque, start.sides[0].torque, start.load_torque)

    def outputs(self) -> Any:
        """Return `DrivelineOutputs` at the current step, each value (R,); the angles are NaN."""
        states: Any = [*self._values[_STATES], *_NO_ANGLES]
        return DrivelineOutputs.of_state(
            self._driveline, self._loads.wheel_radius, states, self._torques
        )

    def load_torque(self, step: int) -> np.ndarray:
        """Return C_load in N m, (R,), at step `step` in the current state."""
        return self._loads.torque(step, self._vehicle_speed)

    def known_load_torque(self, step: int) -> np.ndarray:
        """Return C_load in N m, (R,), of the cars that controllers know, at the true speed."""
        return self._known_loads.torque(step, self._vehicle_speed)

    @property
    def _vehicle_speed(self) -> np.ndarray:
        speed: np.ndarray = self._loads.wheel_radius * self._values[STATES['wheel_speed']]
        return speed

    def static_torque(self, step: int, load_torque: np.ndarray) -> np.ndarray:
        """Return C_fOL of the known cars in N m, (R,), for C_load in N m in the current state."""
        engine_speed, shaft_speed = self._values[STATES.places('engine_speed', 'shaft_speed')]
        return self._static.torque(
            self.engine_torque[step], load_torque, engine_speed, shaft_speed
        )

    def advance(self, step: int, load_torque: np.ndarray, request: np.ndarray) -> None:
        """Advance by 10 ms with C_m and C_load held and the clutch request, (R,) in N m each."""
        values, engine_torque = self._values, self.engine_torque[step]
        self._actuators.request(step, request)
        values[_ENGINE], values[_LOAD] = engine_torque, load_torque
        values[_ACTUATOR] = self._actuators.values
        values[_STATES] = product(self._step, values)
        self._torques = (engine_torque, self._wear * self._actuators.advance(), load_torque)


class Loads:
    """Road loads of R cars as columns, the counterpart of `RoadLoad`."""

    def __init__(self, runs: Sequence[AnySettings], steps: int) -> None:
        """Extend the profiles of the roads to step `steps`."""
        loads = [make_load(run) for run in runs]
        self.wheel_radius: Any = np.array([load.wheel_radius for load in loads])
        """Wheel radii r_w in m, (R,)."""
        self._drag = np.array([load.drag for load in loads])
        self._wind = np.array([load.wind for load in loads])
        times = np.arange(steps + 1) / STEPS_PER_S
        with_slope = times if any(run.scenario.slope.given for run in runs) else times[:1]
        forces = np.stack([load.forces(with_slope) for load in loads], axis=-1)
        self._forces = np.broadcast_to(forces, (steps + 1, len(runs)))

    def torque(self, step: int, vehicle_speed: np.ndarray) -> np.ndarray:
        """Return C_load in N m, (R,), at step `step` at speeds in m/s, (R,)."""
        torque: np.ndarray = resisting_torque(
            self._drag, self._wind, self._forces[step], self.wheel_radius, vehicle_speed
        )
        return torque


def _step_matrices(drivelines: Sequence[DrivelineParameters], nodes: np.ndarray) -> np.ndarray:
    """
    Return the (n, n + 8, R) map to the next states, including actuator and clutch.

    `nodes` (R, 11, 6) map the values of the actuators to C_f within a period.
    """
    first, places = distinct(drivelines)
    steps = step_matrix(stacked([drivelines[index] for index in first]), angles=False)[places]
    # The first columns belong to the states, C_m and C_load, the others to the nodes of C_f.
    first_node = _LOAD + 1
    held, of_nodes = steps[:, :, :first_node], steps[:, :, first_node:]
    matrices = np.concatenate([held, of_nodes @ nodes], axis=-1)
    return np.ascontiguousarray(matrices.transpose(1, 2, 0))


class Actuators:
    """
    Actuators of R runs as columns, the counterpart of `Actuator`.

    Where a delay is a whole number of periods the earlier request has no effect.
    """

    def __init__(
        self, parameters: Sequence[ActuatorParameters], requests: np.ndarray, steps: int
    ) -> None:
        """Start in steady state at requests, (R,) in N m, for `steps` periods."""
        first, places = distinct(parameters)
        periods = np.array([each.delay_substeps // SUBSTEPS for each in parameters])
        made = [_actuator_matrices(parameters[index]) for index in first]
        updates, nodes, rest = (np.stack(each) for each in zip(*made, strict=True))
        self.nodes = nodes[places]
        """Matrices (R, 11, 6) from `values` to the torque at 0, 1, ..., 10 ms."""
        rows = np.concatenate([updates, nodes[:, -1:]], axis=1).transpose(1, 2, 0)
        self._rows = rows[..., 0] if len(first) == 1 else np.take(rows, places, axis=-1)
        delayed = np.maximum(requests, 0.0)
        self.values = np.zeros((_LATER + 1, len(parameters)))
        """States and requests in effect, (6, R); the requests are valid after `request`."""
        self.values[_LAG_STATES] = np.take(rest.T, places, axis=-1) * delayed
        self._before = int(periods.max()) + 1
        self._requests = np.empty((self._before + steps, len(parameters)))
        self._requests[: self._before] = delayed
        alike = bool((periods == periods[0]).all())
        self._later = self._before - (int(periods[0]) if alike else periods)
        self._columns = slice(None) if alike else np.arange(len(parameters))

    def request(self, step: int, requests: np.ndarray) -> None:
        """Store the requests of step k, (R,) in N m, saturated at zero."""
        np.maximum(requests, 0.0, out=self._requests[self._before + step])
        later = self._later + step
        self.values[_EARLIER] = self._requests[later - 1, self._columns]
        self.values[_LATER] = self._requests[later, self._columns]

    def advance(self) -> np.ndarray:
        """Advance to the end of the period; return the torque there, (R,) in N m."""
        followed = product(self._rows, self.values)
        self.values[_LAG_STATES] = followed[:-1]
        return followed[-1]


def _actuator_matrices(
    parameters: ActuatorParameters,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the (4, 6) next state, the (11, 6) nodes and the steady state for 1 N m."""
    model, late = parameters.dynamics(), parameters.delay_substeps % SUBSTEPS
    update, nodes = lifted(model, late)
    if not late:
        update, nodes = (np.insert(each, _EARLIER, 0.0, axis=1) for each in (update, nodes))
    return update, nodes, at_rest(model, 1.0)
