# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The plants of many runs, wired as `Plant` wires that of one."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.actuators import Actuators
from ddct_bringup.batch.engines import Engines
from ddct_bringup.batch.linear_drivelines import LinearDrivelines
from ddct_bringup.batch.loads import Loads
from ddct_bringup.batch.sides import LinearSides
from ddct_plant.models.initial_state import InitialState
from ddct_plant.plant import Observation, PlantReply, Tick
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.plant import make_load
from ddct_plant.scenario.settings import RunSettings


class Plants:
    """
    Plants of R runs, the counterpart of `Plant`: `tick`, `observe`, `reply`, `advance`.

    Their values are those of `Plant`, (R,) each, and (R, 11) for the nodes of a period.
    """

    def __init__(self, runs: Sequence[RunSettings], steps: int) -> None:
        """Start in the initial states; profiles of engine and road extend to step `steps`."""
        scenarios = [run.scenario for run in runs]
        initial = [initial_state(run) for run in runs]
        self._drivelines = LinearDrivelines(scenarios, initial)
        self._engines = Engines(scenarios, steps)
        self._loads = Loads([make_load(run) for run in runs], steps)
        self._sides = [LinearSides(runs, _actuators(runs, initial, 0, steps))]
        """Actuators and clutches of each side; a launch has one."""

    def tick(self, step: int) -> Tick:
        """Return the true outputs and the measurements at step k."""
        true = self._drivelines.outputs()
        demand: Any = self._engines.demand(step)
        return Tick(step, true, true, None, demand)

    def observe(self, tick: Tick) -> Observation:
        """Return what the controllers receive at a tick."""
        demand: Any = tick.demand
        speed: Any = tick.true.engine_speed
        torque: Any = self._engines.torque(demand, speed)
        return Observation(tick, None, torque, torque)

    def reply(self, observation: Observation, torque_request: np.ndarray) -> PlantReply:
        """Return torques and recorded signals of the step of an observation; requests in N m."""
        tick, engine_torque = observation.tick, observation.delivered
        step, true = tick.step, tick.true
        speed: Any = true.vehicle_speed
        load_torque: Any = self._loads.torque(step, speed)
        signals: dict[str, Any] = true.signals
        torques, values = self._sides[0].reply(step, torque_request, true)
        signals.update(values)
        signals['torque_demand'] = tick.demand
        signals['engine_torque'] = engine_torque
        signals['load_torque'] = load_torque
        assert engine_torque is not None
        return PlantReply(engine_torque, load_torque, torques, signals)

    def advance(self, reply: PlantReply) -> None:
        """Integrate the drivelines over one period with the torques of `reply`."""
        torques: Any = (reply.engine_torque, reply.load_torque, *reply.friction_torques)
        self._drivelines.step(*torques)


def _actuators(
    runs: Sequence[RunSettings], initial: Sequence[InitialState], side: int, steps: int
) -> Actuators:
    """Return the actuators of a side, at rest at their requests before t_0."""
    requests = np.array([each.sides[side].torque_request for each in initial])
    return Actuators([run.scenario.actuator for run in runs], requests, steps + 1)
