# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Signals of a run that locks at a given instant, as affine functions of its requests."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.floor.dynamics import propagators
from ddct_bringup.floor.dynamics.capacity import CapacityRange
from ddct_bringup.floor.dynamics.columns import Columns, columns_of
from ddct_bringup.floor.dynamics.engine_laws import EngineLaw
from ddct_bringup.floor.dynamics.inputs import Inputs
from ddct_bringup.floor.dynamics.laws import Law
from ddct_bringup.floor.dynamics.propagators import ENGINE, NODES, SHAFT, TWIST, WHEEL
from ddct_bringup.floor.dynamics.stability import require_stable
from ddct_bringup.floor.dynamics.start import ActuatorModel, Start, driving_acceleration
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.driveline_model import states_and_torques
from ddct_plant.scenario.settings import RunSettings


@dataclass(frozen=True, eq=False)
class Motion:
    """
    Signals of the run, each with one column for each variable of `columns`.

    Rows are the steps 0 to N, or those that a field names. The times are in s from control start.
    """

    start: int
    """Step from which metrics count: control start, also in a gear shift."""
    sign: float
    """Sign of the slip at control start: 1 for an engine that is faster than the shaft."""
    columns: Columns
    acceleration: np.ndarray
    """A_x in m/s^2, left limits, (N + 1, columns)."""
    torsion_speed: np.ndarray
    """Torsion speed w_sr in rad/s, (N + 1, columns)."""
    driving: np.ndarray
    """Driving force over the mass of the car in m/s^2, (N + 1, columns)."""
    slip: np.ndarray
    """Slip w_d in rad/s at the steps after control start while the plates slip, (n, columns)."""
    capacity: np.ndarray
    """Torque of the clutch in N m, not negative, at all nodes from control start on, (n, 11,
    columns)."""
    slip_at_lock: np.ndarray | None
    """Slip in rad/s at the instant of the lock, (columns,)."""
    slip_acceleration: np.ndarray | None
    """dw_d/dt in rad/s^2 just before the lock, (columns,)."""
    engine_speed: np.ndarray
    """w_m in rad/s at the steps from control start to N, (n, columns)."""
    wheel_speed: np.ndarray
    """w_r in rad/s at the steps from control start to N, (n, columns)."""


def motion_of(
    settings: RunSettings,
    start: Start,
    lock_time_s: float | None,
    engine: EngineLaw,
    load: Law,
    capacity: CapacityRange,
    most_request: float,
) -> Motion:
    """
    Return the signals of every run that starts at `start` and locks once, at `lock_time_s`.

    `lock_time_s` counts from control start; None: the clutch is linear, and slips to the end.
    The requests are between 0 and `most_request` in N m. Raise ParameterError for an unstable
    model, and a lock before the off-going clutch of a gear shift is open.
    """
    scenario = settings.scenario
    require_stable(scenario.name, scenario.controlled_driveline, load, engine)
    if start.off_going and lock_time_s is not None:
        start.off_going.require_open(lock_time_s)
    return _Builder(settings, start, lock_time_s, engine, load, capacity, most_request).motion()


class _Builder:
    """Steps the state of the driveline, (4, columns), from control start to the end."""

    def __init__(
        self,
        settings: RunSettings,
        start: Start,
        lock_time_s: float | None,
        engine: EngineLaw,
        load: Law,
        capacity: CapacityRange,
        most_request: float,
    ) -> None:
        self._scenario, self._p = settings.scenario, settings.scenario.controlled_driveline
        self._radius = settings.scenario.vehicle.wheel_radius_m
        self._start = start
        self._periods = settings.scenario.steps - start.step
        self._sign = 1.0 if settings.stick_slip is False or start.slip >= 0.0 else -1.0
        self._lock = None if lock_time_s is None else divmod_period(lock_time_s)
        self._slipping_periods = self._periods if self._lock is None else self._lock[0] + 1
        self.columns = columns_of(
            max(self._slipping_periods - ActuatorModel.of(settings).delays[-1], 0),
            most_request,
            load,
            engine,
            capacity,
            self._periods,
            self._slipping_periods,
            start.off_going,
        )
        self._inputs = Inputs(settings, start, engine, load, capacity, self.columns)

    def motion(self) -> Motion:
        """Return the signals."""
        state = np.zeros((4, self.columns.count))
        state[:, 0] = self._start.state
        slipping, locked = propagators.slipping(self._p), propagators.locked(self._p)
        states, loads, capacities = [state], [], []
        whole = np.zeros((6 + NODES, self.columns.count))
        slip_at_lock = slip_acceleration = None
        for k in range(self._periods):
            whole[:4], whole[4], whole[5] = (
                state,
                self._inputs.engine(k, state),
                self._inputs.load(k, state),
            )
            loads.append(whole[5].copy())
            if k < self._slipping_periods:
                capacities.append(self._inputs.clutch(k))
                np.multiply(self._sign, capacities[-1], out=whole[6:])
            inputs = whole[4:]
            if self._lock is None or k < self._lock[0]:
                state = slipping @ whole
            elif k == self._lock[0]:
                state = propagators.slipping_for(self._p, self._lock[1]) @ whole
                slip_at_lock = state[ENGINE] - state[SHAFT]
                slip_acceleration = self._slip_acceleration(state, inputs)
                after = propagators.locked(self._p, PERIOD_S - self._lock[1])
                state = (
                    after[:, :4] @ propagators.joined(self._p) @ state + after[:, 4:] @ inputs[:2]
                )
            else:
                state = locked @ whole[:6]
            self._inputs.add_off_going(k, state)
            states.append(state)
        return self._signals(states, loads, capacities, slip_at_lock, slip_acceleration)

    def _slip_acceleration(self, state: np.ndarray, inputs: np.ndarray) -> np.ndarray:
        assert self._lock is not None
        a, b = states_and_torques(self._p)
        weights = propagators.interpolated(self._lock[1])
        torques = np.vstack([inputs[0], weights @ inputs[2:], inputs[1]])
        rates = a @ state + b @ torques
        return rates[ENGINE] - rates[SHAFT]

    def _signals(
        self,
        states: list[np.ndarray],
        loads: list[np.ndarray],
        capacities: list[np.ndarray],
        slip_at_lock: np.ndarray | None,
        slip_acceleration: np.ndarray | None,
    ) -> Motion:
        p, start = self._p, self._start.step
        shape = (start + self._periods + 1, self.columns.count)
        acceleration, torsion, driving = np.zeros(shape), np.zeros(shape), np.zeros(shape)
        acceleration[: start + 1, 0] = self._start.accelerations
        torsion[: start + 1, 0] = self._start.torsion_speeds
        driving[: start + 1, 0] = self._start.driving
        path = np.array(states)
        speed = p.gear.wheel_speed(path[:, SHAFT]) - path[:, WHEEL]
        torque = p.halfshaft_damping * speed + p.halfshaft_stiffness * path[:, TWIST]
        torsion[start + 1 :] = speed[1:]
        scale = self._radius / p.vehicle_inertia
        acceleration[start + 1 :] = scale * (torque[1:] - np.array(loads))
        driving[start + 1 :] = driving_acceleration(self._scenario, torque[1:])
        slipping = self._slipping_periods + (self._lock is None)
        return Motion(
            self._start.scored_from,
            self._sign,
            self.columns,
            acceleration,
            torsion,
            driving,
            path[1:slipping, ENGINE] - path[1:slipping, SHAFT],
            np.array(capacities),
            slip_at_lock,
            slip_acceleration,
            path[:, ENGINE],
            path[:, WHEEL],
        )


def divmod_period(time_s: float) -> tuple[int, float]:
    """Return the whole periods in a time in s, and the rest in s; a step ends a period."""
    # A rest below a nanosecond is rounding: the period that ends there is then whole.
    whole = int(time_s / PERIOD_S - 1e-7)
    return whole, min(time_s - whole * PERIOD_S, PERIOD_S)
