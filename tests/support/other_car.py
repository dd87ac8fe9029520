"""
A car that is not ours, simulated by code of its own: a log as another tool would write it.

Equations of motion are written here again, from the free bodies, and integrated by scipy.
"""

from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

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
"""That of the scenario `thesis`, whose drag the car shares."""
ROLLING_N_M = 75.0
STEP_S = 0.008
LASTS_S = 4.8
SPEEDS = ('engine_speed', 'shaft_speed', 'wheel_speed')
NOISE_RAD_S = np.array([0.2, 0.2, 0.02])


@dataclass(frozen=True)
class Drive:
    """A drive without noise."""

    time_s: np.ndarray
    speeds: np.ndarray
    """(n, 3) rad/s."""
    engine_torque: np.ndarray
    clutch_torque: np.ndarray
    accel: np.ndarray
    """(n,) m/s^2."""
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
def drive(seed: int = 1) -> Drive:
    """Return a drive over random torques, straight between points 0.24 s apart."""
    random = np.random.default_rng(seed)
    points = np.arange(0.0, LASTS_S + 0.5, 0.24)
    of_clutch = 110.0 + 90.0 * random.uniform(-1.0, 1.0, len(points))
    of_engine = of_clutch + 40.0 * random.uniform(-1.0, 1.0, len(points))
    p = TRUE

    def motion(t: float, state: np.ndarray) -> list[float]:
        engine, shaft, wheel, wind_up = state
        clutch_torque = np.interp(t, points, of_clutch)
        engine_torque = np.interp(t, points, of_engine)
        rate = shaft / p['total_ratio'] - wheel
        half_shaft = p['halfshaft_stiffness'] * wind_up + p['halfshaft_damping'] * rate
        air = 0.5 * 1.2 * 2.1 * 0.32 * (wheel * RADIUS_M) ** 2 * RADIUS_M
        return [
            (engine_torque - clutch_torque - p['engine_damping'] * engine) / p['engine_inertia'],
            (clutch_torque - half_shaft / p['total_ratio'] - p['shaft_damping'] * shaft)
            / p['shaft_inertia'],
            (half_shaft - ROLLING_N_M - air) / p['vehicle_inertia'],
            rate,
        ]

    start = [190.0, 150.0, 150.0 / p['total_ratio'], 0.02]
    time_s = np.arange(round(LASTS_S / STEP_S) + 1) * STEP_S
    span, tight = (0.0, LASTS_S + STEP_S), {'rtol': 1e-8, 'atol': 1e-8, 'max_step': 0.01}
    done = solve_ivp(motion, span, start, 'RK45', time_s, **tight)
    rates = [motion(t, state) for t, state in zip(time_s, done.y.T, strict=True)]
    return Drive(
        time_s,
        done.y[:3].T,
        np.interp(time_s, points, of_engine),
        np.interp(time_s, points, of_clutch),
        RADIUS_M * np.array(rates)[:, 2],
    )


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
