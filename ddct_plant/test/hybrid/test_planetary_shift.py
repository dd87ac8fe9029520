# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The hybrid integrator on Modelica.Mechanics.Rotational.Examples.SimpleGearShift."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest
import scipy
from modes import mode_at

from ddct_plant.hybrid.friction_system import FrictionSystem
from ddct_plant.hybrid.integrator import HybridIntegrator

PIECE_S, PIECES, END_S = 1e-4, 50, 5.0
CLUTCH, BRAKE = 0, 1
RATIO = 75.0 / 50.0
"""Teeth of the ring over those of the sun."""
INERTIAS = np.array([1.0, 10.0])
"""Inertias of engine (sun) and load (carrier) in kg m^2; the ring has none."""
SLIPS = np.array([[1.0, -1.0], [-1.0, 1.0 + RATIO]]) * [[(1.0 + RATIO) / RATIO], [1.0 / RATIO]]
"""Slip of the clutch, sun less ring, and of the brake, the ring's speed, as rows on the speeds."""


def engine_torque(time: Any) -> Any:
    """Return the engine torque in N m: a step at 0.5 s."""
    return np.where(np.asarray(time) >= 0.5, 20.0, 0.0)


def load_torque(speed: Any) -> Any:
    """Return the load torque in N m, quadratic: 20 N m at 100 rpm."""
    return 20.0 * (speed / 10.471975511966) ** 2


def capacities(time: Any) -> np.ndarray:
    """Return the capacities of clutch and brake in N m, with ramps from 2 s to 2.1 s."""
    share = np.clip((np.asarray(time) - 2.0) / 0.1, 0.0, 1.0)
    return np.array([100.0 * share, 100.0 * (1.0 - share)])


class Mode(NamedTuple):
    """A mode of the reference: which element sticks, if any, and the sign of the brake's slip."""

    stuck: int | None
    brake_sign: int


class Reference:
    """The same shift by the Dormand-Prince method of order 8, mode by mode in a known order."""

    def __init__(self) -> None:
        self.events: list[tuple[int, str, float]] = []
        self.parts: list[tuple[float, Any]] = []
        state, time = np.zeros(2), 0.5
        mode = Mode(BRAKE, 0)
        state, time = self._run(mode, state, time, 2.0, None)
        state, time = self._run(mode, state, time, 2.1, self._margin(mode))
        self.events.append((BRAKE, 'release', time))
        slope = self._slope(Mode(None, -1), time, state)
        mode = Mode(None, -1 if SLIPS[BRAKE] @ slope < 0.0 else 1)
        while time < 2.1:
            state, time = self._run(mode, state, time, 2.1, self._clutch_slip)
        state, time = self._run(mode, state, time, END_S, self._clutch_slip)
        self.events.append((CLUTCH, 'lock', time))
        self.state, _ = self._run(Mode(CLUTCH, mode.brake_sign), state, time, END_S, None)

    def _torques(self, mode: Mode, time: float, state: np.ndarray) -> np.ndarray:
        torques = capacities(time) * [1.0, mode.brake_sign]
        if mode.stuck is None:
            return torques
        torques[mode.stuck] = 0.0
        row = SLIPS[mode.stuck]
        free = self._accelerations(torques, time, state)
        torques[mode.stuck] = row @ free / (row @ (row / INERTIAS))
        return torques

    def _accelerations(self, torques: np.ndarray, time: float, state: np.ndarray) -> np.ndarray:
        driven = np.array([20.0 if time >= 0.5 else 0.0, -load_torque(state[1])])
        return (driven - SLIPS.T @ torques) / INERTIAS

    def _slope(self, mode: Mode, time: float, state: np.ndarray) -> np.ndarray:
        return self._accelerations(self._torques(mode, time, state), time, state)

    def _margin(self, mode: Mode) -> Callable[[float, np.ndarray], float]:
        def margin(time: float, state: np.ndarray) -> float:
            torque = abs(self._torques(mode, time, state)[BRAKE])
            return float(capacities(time)[BRAKE] - torque)

        return margin

    @staticmethod
    def _clutch_slip(time: float, state: np.ndarray) -> float:
        return float(SLIPS[CLUTCH] @ state)

    def _run(
        self, mode: Mode, state: np.ndarray, start: float, end: float, guard: Any
    ) -> tuple[np.ndarray, float]:
        """Integrate until `end`, or until the guard falls to zero."""
        if guard is not None:

            def event(time: float, state: np.ndarray) -> float:
                return guard(time, state)

            watched: Any = event
            watched.terminal, watched.direction = True, -1.0
        done = scipy.integrate.solve_ivp(
            lambda time, now: self._slope(mode, time, now),
            (start, end),
            state,
            'DOP853',
            events=None if guard is None else [watched],
            dense_output=True,
            rtol=1e-12,
            atol=1e-12,
        )
        self.parts.append((float(done.t[-1]), done.sol))
        return done.y[:, -1], float(done.t[-1])

    def load(self, times: np.ndarray) -> np.ndarray:
        """Return the load torque in N m at times in s."""
        found = np.zeros(len(times))
        for i, time in enumerate(times):
            if time > 0.5:
                sol = next(sol for end, sol in self.parts if time <= end + 1e-12)
                found[i] = load_torque(sol(time)[1])
        return found


def test_a_shift_by_clutch_and_brake_of_a_planetary_gear_has_the_events_of_another_method():
    """Both act on both bodies; the load torque is that of the other method, as an input."""
    reference = Reference()
    system = FrictionSystem(
        np.zeros((2, 2)), np.diag([1.0, -1.0] / INERTIAS), -SLIPS.T / INERTIAS[:, None], SLIPS
    )
    integrator = HybridIntegrator(system, PIECE_S, PIECES, held=[0])
    state = [0.0, 0.0]
    signs = mode_at(integrator.system, state)
    events = []
    for interval in range(round(END_S / (PIECE_S * PIECES))):
        start_s = interval * PIECE_S * PIECES
        nodes = start_s + PIECE_S * np.arange(PIECES + 1)
        inputs = [float(engine_torque(start_s + 1e-9)), *reference.load(nodes)]
        limits = capacities(nodes).ravel()
        done = integrator.advance(state, signs, inputs, limits, limits)
        events += [(e.element, e.kind, start_s + e.time_s) for e in done.events]
        state, signs = done.state, done.signs
    shift = [event for event in events if event[2] > 1.0]
    assert [event[:2] for event in shift] == [event[:2] for event in reference.events]
    times = [event[2] for event in reference.events]
    assert [event[2] for event in shift] == pytest.approx(times, abs=1e-8)
    assert 2.0 < times[0] < times[1] < 3.0
    assert signs[CLUTCH] == 0
    assert state == pytest.approx(reference.state, rel=1e-8)
    assert state[0] == pytest.approx(state[1], rel=1e-12)
