# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The plants of many runs, wired as `Plant` wires that of one."""

from collections.abc import Hashable, Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.plant.actuators import Actuators
from ddct_bringup.batch.plant.engines import Engines
from ddct_bringup.batch.plant.friction_drivelines import FrictionDrivelines, RunEvents
from ddct_bringup.batch.plant.linear_drivelines import LinearDrivelines
from ddct_bringup.batch.plant.sensors import StackedSensors
from ddct_bringup.batch.plant.sides import LinearSides, StickSlipSides
from ddct_plant.base.timebase import STEPS_PER_S
from ddct_plant.models.initial_state import InitialState
from ddct_plant.models.load import RoadLoad, resisting_torque
from ddct_plant.plant import Observation, PlantReply, Tick
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.plant import engagement_steps, holding_torque, make_load
from ddct_plant.scenario.rules.shift import gears_of
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.shift.roles import ROLES


class Loads:
    """Road loads of R cars, the counterpart of `RoadLoad`."""

    def __init__(self, loads: Sequence[RoadLoad], steps: int) -> None:
        """Extend the profiles of the roads to step `steps`."""
        self.wheel_radius = np.array([load.wheel_radius for load in loads])
        """Wheel radii r_w in m, (R,)."""
        self._drag = np.array([load.drag for load in loads])
        self._wind = np.array([load.wind for load in loads])
        times = np.arange(steps + 1) / STEPS_PER_S
        self._forces = np.stack([load.forces(times) for load in loads], axis=-1)

    def torque(self, step: int, vehicle_speed: np.ndarray) -> np.ndarray:
        """Return C_load in N m, (R,), at step `step` at speeds in m/s, (R,)."""
        torque: np.ndarray = resisting_torque(
            self._drag, self._wind, self._forces[step], self.wheel_radius, vehicle_speed
        )
        return torque


def plant_kind(settings: RunSettings) -> Hashable:
    """Return what runs with common `Plants` share."""
    scenario = settings.scenario
    changes = tuple(engagement_steps(scenario.shift)[1]) if scenario.shift else None
    return settings.stick_slip, scenario.sensors is not None, changes


class Plants:
    """
    Plants of R runs, the counterpart of `Plant`: `tick`, `observe`, `reply`, `advance`.

    Their values are those of `Plant`, (R,) each, and (R, 11) for the nodes of a period.
    """

    def __init__(self, runs: Sequence[RunSettings], steps: int) -> None:
        """Start in the initial states; profiles of engine and road extend to step `steps`."""
        scenarios = [run.scenario for run in runs]
        initial = [initial_state(run) for run in runs]
        self._sensors = StackedSensors(runs, steps) if scenarios[0].sensors else None
        self._engines = Engines(scenarios, steps)
        self._loads = Loads([make_load(run) for run in runs], steps)
        actuators = [
            _actuators(runs, initial, side, steps) for side in range(len(initial[0].sides))
        ]
        self._drivelines: FrictionDrivelines | LinearDrivelines
        self._sides: list[StickSlipSides | LinearSides]
        self._holding: np.ndarray | None = None
        self._ratios = (
            np.array([gears_of(run.known.scenario).ratio for run in runs])
            if runs[0].shift
            else None
        )
        if runs[0].stick_slip:
            self._drivelines = FrictionDrivelines(scenarios, initial)
            self._sides = [
                StickSlipSides(runs, *each) for each in zip(actuators, ROLES, strict=False)
            ]
            times = np.arange(steps + 1) / STEPS_PER_S
            capacities = [holding_torque(run).over(times) for run in runs]
            self._holding = np.stack(capacities, axis=-1)
        else:
            angles = self._sensors is not None
            self._drivelines = LinearDrivelines(scenarios, initial, angles=angles)
            self._sides = [LinearSides(runs, actuators[0])]

    def tick(self, step: int) -> Tick:
        """Return the true outputs and the measurements at step k."""
        true = self._drivelines.outputs()
        demand: Any = self._engines.demand(step)
        off_going: Any = true.off_going and true.off_going.slip_speed
        if self._sensors is None:
            return Tick(step, true, true, off_going, demand)
        measured: Any = self._sensors.speeds(step, true)
        if self._ratios is not None:
            off_going = measured.engine_speed - self._ratios * measured.shaft_speed
        return Tick(step, true, measured, off_going, demand)

    def observe(self, tick: Tick, torque_cut: Any = None) -> Observation:
        """
        Return what the controllers receive at a tick.

        `torque_cut` in N m, (R,), is what the handovers of shifts take off the driver's demand.
        """
        demand: Any = tick.demand
        speed: Any = tick.true.engine_speed
        requested = None if torque_cut is None else demand - torque_cut
        torque: Any = self._engines.torque(demand, requested, speed)
        reported: Any = torque
        if self._sensors is not None:
            reported = self._sensors.torque(tick.step, torque)
        return Observation(tick, requested, torque, reported)

    def reply(
        self, observation: Observation, torque_request: np.ndarray, off_going_request: Any = None
    ) -> PlantReply:
        """
        Return torques and recorded signals of the step of an observation.

        The requests, (R,) in N m, are those of the clutches; only a shift has an off-going one.
        """
        tick, engine_torque = observation.tick, observation.delivered
        step, true = tick.step, tick.true
        speed: Any = true.vehicle_speed
        load_torque: Any = self._loads.torque(step, speed)
        signals: dict[str, Any] = true.signals
        torques, values = self._sides[0].reply(step, torque_request, true)
        signals.update(values)
        if true.off_going is not None:
            side = self._sides[1]
            of_other, values = side.reply(step, off_going_request, true.off_going)
            torques += of_other
            signals.update(values)
        if self._holding is not None:
            torques = self._holding[step], *torques
        signals['torque_demand'] = tick.demand
        signals['engine_torque'] = engine_torque
        signals['load_torque'] = load_torque
        assert engine_torque is not None
        return PlantReply(engine_torque, load_torque, torques, signals)

    def over(self, tick: Tick) -> np.ndarray:
        """Return whether a run ends with the state of a tick, (R,), as its engine ends it."""
        speed: Any = tick.true.engine_speed
        return self._engines.over(speed)

    @property
    def phase_events(self) -> dict[str, RunEvents]:
        """Events in the last period, by the name of their signal."""
        return self._drivelines.phase_events

    @property
    def unsure(self) -> np.ndarray:
        """Runs that must be computed step by step, (R,)."""
        failed = self._drivelines.failed
        return failed if self._sensors is None else failed | self._sensors.unsure

    def advance(self, reply: PlantReply, running: np.ndarray) -> None:
        """Integrate the drivelines of the runs of a mask, (R,), with the torques of `reply`."""
        torques: Any = (reply.engine_torque, reply.load_torque, *reply.friction_torques)
        self._drivelines.step(running, *torques)


def _actuators(
    runs: Sequence[RunSettings], initial: Sequence[InitialState], side: int, steps: int
) -> Actuators:
    """Return the actuators of a side, at rest at their requests before t_0."""
    requests = np.array([each.sides[side].torque_request for each in initial])
    return Actuators([run.scenario.actuator for run in runs], requests, steps + 1)
