# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Logs of drives with noise and with delayed signals."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from ddct_bringup.identification.from_log.base_car import drag_of
from ddct_bringup.identification.from_log.command import NEEDED
from ddct_bringup.identification.from_log.fit import fit_log
from ddct_bringup.identification.from_log.prediction import SpeedPrediction, predict
from ddct_bringup.identification.from_log.result import LogFit
from ddct_bringup.identification.from_log.stretches import TORQUES, stretches_of
from ddct_bringup.identification.from_log.verdict import reasons_against
from ddct_bringup.identification.identify import main
from ddct_bringup.logs.columns import TIME, own_columns
from ddct_bringup.logs.log import SPEEDS, MeasuredLog, read_log
from ddct_bringup.scores.csv_text import signals_csv
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.scenario import Scenario
from support.other_car import TRUE, drive
from support.runs import plan, record

NONE_LATE = {'shaft_speed': 0.0, 'wheel_speed': 0.0, 'engine_torque': 0.0, 'clutch_torque': 0.0}
"""Delays of a log without any, against the engine speed."""


def drag(wheel_speed: np.ndarray) -> np.ndarray:
    """Return the drag of the car of `other_car` in N m at the wheels."""
    return 0.4032 * 0.3211344993404892**3 * wheel_speed**2


def drive_log(folder: Path, controller: str = 'pi', changes: tuple[str, ...] = ()) -> MeasuredLog:
    """Return the log of a run of the thesis's scenario, rows every 10 ms, as CSV in a folder."""
    run = record(
        plan(controller, 'headless', duration_s=3.0, changes=changes), folder / controller
    )
    file = folder / f'{controller}.csv'
    file.write_text(signals_csv(run))
    return read_log(file, own_columns(TIME, *NEEDED), NEEDED)


def log_of(signals: dict[str, np.ndarray], time_s: np.ndarray | None = None) -> MeasuredLog:
    """Return a log of signals, at the times of `drive` unless there are others."""
    times = drive().time_s if time_s is None else time_s
    return MeasuredLog(Path('a.csv'), '', times, signals)


def hits(fit: LogFit) -> list[bool]:
    """Return for each fitted parameter whether its interval has the value of `other_car`."""
    found = []
    for name in fit.std:
        lowest, highest = fit.interval(name) or (np.nan, np.nan)
        found.append(lowest <= TRUE[name] <= highest)
    return found


def constant_log() -> MeasuredLog:
    """Return a noisy log of a drive at constant speed."""
    random, count = np.random.default_rng(5), len(drive().time_s)
    levels = {'engine_speed': 190.0, 'shaft_speed': 150.0, 'wheel_speed': 12.0}
    signals = {n: each + 0.1 * random.standard_normal(count) for n, each in levels.items()}
    torques = ('engine_torque', 'clutch_torque')
    return log_of(signals | {name: np.full(count, 6.0) for name in torques})


def judged(
    signals: dict[str, np.ndarray], times: np.ndarray, known: dict[str, float] | None = None
) -> tuple[LogFit, list[SpeedPrediction], list[str]]:
    """Return a fit to 70 % of a log, its prediction of the rest, and the reasons against it."""
    log = MeasuredLog(Path('a.csv'), '', times, signals)
    parting = times[0] + 0.7 * (times[-1] - times[0])
    first, rest = log.part(times[0], parting), log.part(parting, times[-1])
    fit = fit_log(first, DrivelineParameters(), drag, (), known or {})
    predictions = predict(fit, stretches_of(rest, drag))
    return fit, predictions, reasons_against(fit, predictions, stretches_of(first, drag))


def noisy_log(log: MeasuredLog, seed: int, size: float = 0.1) -> MeasuredLog:
    """Return a log with white noise on its speeds, of a size in rad/s."""
    random = np.random.default_rng(seed)
    signals = dict(log.signals)
    for name in SPEEDS:
        signals[name] = signals[name] + size * random.standard_normal(len(log.time_s))
    return replace(log, signals=signals)


def noisy_log_of(times: np.ndarray, signals: dict[str, np.ndarray], seed: int) -> MeasuredLog:
    """Return a log of signals at times, with white noise on its speeds."""
    return noisy_log(MeasuredLog(Path('a.csv'), '', times, signals), seed)


def within(fit: LogFit, true: dict[str, float]) -> list[bool]:
    """Return for each true value, by name, whether its interval has it."""
    found = []
    for name, value in true.items():
        lowest, highest = fit.interval(name) or (np.nan, np.nan)
        found.append(lowest <= value <= highest)
    return found


def rows_late(log: MeasuredLog, names: Sequence[str], rows: int) -> MeasuredLog:
    """Return a log with some of its signals delayed by `rows` rows, without the first rows."""
    signals = {
        name: values[:-rows] if name in names else values[rows:]
        for name, values in log.signals.items()
    }
    return replace(log, time_s=log.time_s[rows:], signals=signals)


@cache
def late_fit(log: MeasuredLog, seed: int, late: tuple[str, ...], rows: int) -> LogFit:
    """Return the fit to a log of the thesis's car with noise, and with signals rows late."""
    thesis = load_scenario('thesis')
    noisy = rows_late(noisy_log(log, seed), late, rows)
    return fit_log(noisy, thesis.driveline, drag_of(thesis))


def require_delays_alone(
    log: MeasuredLog, late: Sequence[str], rows: int, true: dict[str, float]
) -> None:
    """
    Require that signals that are rows late, in a log of the thesis's car, move delays alone.

    Of 24 intervals 23 are expected. Without fitted delays it is 16 of 54 parameters.
    """
    thesis = load_scenario('thesis')
    fits = [late_fit(log, seed, tuple(late), rows) for seed in (1, 2)]
    assert sum(sum(within(fit, thesis.driveline.values() | true)) for fit in fits) >= 21
    for fit in fits:
        assert fit.delays['clutch_torque'] == pytest.approx(true['clutch_torque'], abs=1e-3)
        assert fit.values['halfshaft_stiffness'] == pytest.approx(6716.3, rel=0.03)
        assert fit.values['engine_inertia'] == pytest.approx(0.25, rel=0.01)


def speeds_late(late_s: float) -> dict[str, float]:
    """Return the delays against the engine speed where all speeds are late."""
    torques = dict.fromkeys(TORQUES, -late_s)
    return {'shaft_speed': 0.0, 'wheel_speed': 0.0} | torques


def identify(folder: Path, *options: str) -> int:
    """Run `identify` on the log and column map of a folder; return the exit code."""
    log = ['--from', str(folder / 'drive.csv'), '--columns', str(folder / 'map.yaml')]
    return main([*log, *options])


def written(folder: Path, log: str = 'drive', overrides: Sequence[str] = ()) -> Scenario:
    """Return the scenario of the car and drive that `identify` wrote for a log into a folder."""
    car, drive_file = (str(folder / f'{log}_{noun}.yaml') for noun in ('car', 'drive'))
    return load_scenario(None, overrides, car=car, drive=drive_file)
