# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Another car, simulated by code of its own: a log as another tool would write it.

Equations of motion are derived again from the free bodies, and integrated by scipy.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
import scipy

TRUE = {
    'engine_inertia': 0.18,
    'engine_damping': 0.02,
    'shaft_inertia': 0.016,
    'shaft_damping': 0.03,
    'halfshaft_damping': 80.0,
    'halfshaft_stiffness': 9000.0,
    'total_ratio': 12.5,
    'vehicle_inertia': 190.0,
}
RADIUS_M = 0.3211344993404892
"""Wheel radius of the scenario `thesis`, m, whose drag the car shares."""
ROLLING_N_M = 75.0
STEP_S = 0.008
LASTS_S = 4.8
SPEEDS = ('engine_speed', 'shaft_speed', 'wheel_speed')
NOISE_RAD_S = np.array([0.2, 0.2, 0.02])


@dataclass(frozen=True)
class Drive:
    """Signals of a drive without noise."""

    time_s: np.ndarray
    speeds: np.ndarray
    """Speeds of engine, shaft and wheels, (n, 3), rad/s."""
    engine_torque: np.ndarray
    clutch_torque: np.ndarray
    accel: np.ndarray
    """Acceleration of the vehicle, (n,), m/s^2."""
    signals: dict[str, np.ndarray] = field(init=False)

    def __post_init__(self) -> None:
        torques = {'engine_torque': self.engine_torque, 'clutch_torque': self.clutch_torque}
        speeds = dict(zip(SPEEDS, self.speeds.T, strict=True))
        object.__setattr__(self, 'signals', speeds | torques)

    def noisy(self, seed: int, torque_noise_n_m: float = 0.0) -> dict[str, np.ndarray]:
        """Return the signals by quantity with white noise of the sensors."""
        random = np.random.default_rng(seed)
        found = dict(self.signals)
        for name, size in zip(SPEEDS, NOISE_RAD_S, strict=True):
            found[name] = found[name] + size * random.standard_normal(len(self.time_s))
        for name in ('engine_torque', 'clutch_torque'):
            noise = torque_noise_n_m * random.standard_normal(len(self.time_s))
            found[name] = found[name] + noise
        return found


@cache
def _solved(seed: int, corners_s: tuple[float, float] = (0.0, 0.0)) -> tuple[Any, Any, Any, Any]:
    """Return functions of time of a drive: C_m, C_f, the state and its rate."""
    random = np.random.default_rng(seed)
    points = np.arange(0.0, LASTS_S + 0.5, 0.24)
    of_clutch = 110.0 + 90.0 * random.uniform(-1.0, 1.0, len(points))
    of_engine = of_clutch + 40.0 * random.uniform(-1.0, 1.0, len(points))
    engine_torque = partial(np.interp, xp=points - corners_s[0], fp=of_engine)
    clutch_torque = partial(np.interp, xp=points - corners_s[1], fp=of_clutch)
    p = TRUE

    def motion(t: float, state: np.ndarray) -> list[float]:
        engine, shaft, wheel, wind_up = state
        rate = shaft / p['total_ratio'] - wheel
        half_shaft = p['halfshaft_stiffness'] * wind_up + p['halfshaft_damping'] * rate
        air = 0.5 * 1.2 * 2.1 * 0.32 * (wheel * RADIUS_M) ** 2 * RADIUS_M
        friction_torque = float(clutch_torque(t))
        return [
            (float(engine_torque(t)) - friction_torque - p['engine_damping'] * engine)
            / p['engine_inertia'],
            (friction_torque - half_shaft / p['total_ratio'] - p['shaft_damping'] * shaft)
            / p['shaft_inertia'],
            (half_shaft - ROLLING_N_M - air) / p['vehicle_inertia'],
            rate,
        ]

    start = [190.0, 150.0, 150.0 / p['total_ratio'], 0.02]
    span, tight = (0.0, LASTS_S + STEP_S), {'rtol': 1e-8, 'atol': 1e-8, 'max_step': 0.01}
    done = scipy.integrate.solve_ivp(motion, span, start, 'RK45', dense_output=True, **tight)
    return engine_torque, clutch_torque, done.sol, motion


@cache
def drive(seed: int = 1) -> Drive:
    """Return a drive over random torques, straight between points 0.24 s apart."""
    engine_torque, clutch_torque, state, motion = _solved(seed)
    time_s = np.arange(round(LASTS_S / STEP_S) + 1) * STEP_S
    states = state(time_s)
    rates = [motion(t, each) for t, each in zip(time_s, states.T, strict=True)]
    return Drive(
        time_s,
        states[:3].T,
        engine_torque(time_s),
        clutch_torque(time_s),
        RADIUS_M * np.array(rates)[:, 2],
    )


def _output(state: Any, index: int, times: np.ndarray) -> np.ndarray:
    return state(times)[index]


def late_log(
    seed: int,
    delays_s: Mapping[str, float],
    *,
    step_s: float = 0.01,
    mean_of: int = 1,
    corners_on_rows: bool = False,
) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """
    Return times and signals of a drive whose log has signals late, in s by quantity.

    `mean_of` samples of each row's step are averaged, the row's own the last. The torques have
    their corners where a row samples them, or at instants of their own.
    """
    late_by = [delays_s.get(name, 0.0) for name in ('engine_torque', 'clutch_torque')]
    corners = (late_by[0], late_by[1]) if corners_on_rows else (0.0, 0.0)
    engine_torque, clutch_torque, state, _ = _solved(seed, corners)
    time_s = np.arange(0.1, LASTS_S - 0.1, step_s)
    within = np.arange(mean_of) * step_s / mean_of

    def late(name: str, values: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
        times = time_s - delays_s.get(name, 0.0)
        return np.mean([values(times - each) for each in within], axis=0)

    signals = {name: late(name, partial(_output, state, i)) for i, name in enumerate(SPEEDS)}
    torques = {'engine_torque': engine_torque, 'clutch_torque': clutch_torque}
    return time_s, signals | {name: late(name, each) for name, each in torques.items()}


COLUMNS = """\
columns:
  time: {column: Zeit, unit: ms}
  engine_speed: {column: nMot, unit: rpm}
  shaft_speed: {column: nEin, unit: rpm}
  wheel_speed: {column: omRad, unit: rad/s}
  engine_torque: {column: MdMot, unit: N m}
  clutch_torque: {column: MdKup, unit: Nm}
"""


def write_csv(path: Path, seed: int, of: Drive) -> Path:
    """Write a noisy log with other names, units, delimiter and decimal mark."""
    noisy, rpm = of.noisy(seed), 30.0 / np.pi
    columns = {
        'Zeit': 1e3 * (of.time_s + 700.0),
        'nMot': rpm * noisy['engine_speed'],
        'nEin': rpm * noisy['shaft_speed'],
        'omRad': noisy['wheel_speed'],
        'MdMot': noisy['engine_torque'],
        'MdKup': noisy['clutch_torque'],
        'ax': of.accel / 9.80665,
    }
    rows = [';'.join(f'{each:.6f}' for each in row) for row in zip(*columns.values(), strict=True)]
    text = '\n'.join(['# a test bench', ';'.join(columns), *rows]) + '\n'
    path.write_text(text.replace('.', ','))
    return path
