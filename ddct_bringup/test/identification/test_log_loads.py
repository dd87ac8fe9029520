# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""C_load of a log: its fitted mean over gaps, and its computed part between the samples."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ddct_bringup.identification.from_log.fit import fit_log
from ddct_bringup.identification.from_log.response import responses
from ddct_bringup.identification.from_log.stretches import (
    INPUTS,
    OUTPUTS,
    TORQUES,
    Stretch,
    stretches_of,
)
from ddct_bringup.logs.columns import OWN_HELD, own_columns
from ddct_bringup.logs.log import SPEEDS, MeasuredLog
from ddct_plant.models.parameters import DrivelineParameters

RATIO = DrivelineParameters().gear.total_ratio
SAMPLES = (400, 80)
LOADS_N_M = (100.0, 400.0)


def part(start_s: float, samples: int, load_n_m: float, random: np.random.Generator) -> Stretch:
    """Return what the model makes of random torques, with a constant load."""
    time_s = start_s + 0.01 * np.arange(samples)
    points = np.arange(time_s[0], time_s[-1] + 0.5, 0.2)
    torques = [np.interp(time_s, points, random.uniform(50.0, 250.0, len(points))) for _ in 'mf']
    table = np.column_stack([*torques, np.zeros(samples)])
    stretch = Stretch(
        time_s,
        np.zeros((samples, 3)),
        time_s,
        table,
        held=(False, False, False),
        load_known=False,
    )
    forced, basis = responses(DrivelineParameters().values(), stretch)
    speeds = forced + basis @ np.array([200.0, 180.0, 180.0 / RATIO, 0.02, load_n_m])
    noise = 1e-3 * random.standard_normal(speeds.shape)
    return replace(stretch, speeds=speeds + noise)


def test_a_stretch_counts_by_its_length() -> None:
    random = np.random.default_rng(4)
    parts = [
        part(10.0 * index, samples, load, random)
        for index, (samples, load) in enumerate(zip(SAMPLES, LOADS_N_M, strict=True))
    ]
    speeds, torques = (
        np.vstack([getattr(each, name) for each in parts]) for name in ('speeds', 'torques')
    )
    signals = dict(zip(SPEEDS, speeds.T, strict=True)) | dict(
        zip(TORQUES, torques.T[:2], strict=True)
    )
    log = MeasuredLog(
        Path('drive.csv'), '', np.concatenate([each.time_s for each in parts]), signals
    )
    names = list(DrivelineParameters().values())
    fixed = [name for name in names if name != 'vehicle_inertia']
    on_time = dict.fromkeys((*SPEEDS, *TORQUES), 0.0)
    fit = fit_log(log, DrivelineParameters(), lambda wheels: np.zeros(len(wheels)), fixed, on_time)
    assert fit.load_torque == pytest.approx(np.average(LOADS_N_M, weights=SAMPLES), abs=2.0)
    assert abs(fit.load_torque - np.mean(LOADS_N_M)) > 90.0


def test_columns_of_a_stretch_are_found_by_name() -> None:
    one, two = (np.arange(3.0 * n).reshape(n, 3) for n in (2, 4))
    stretch = Stretch(np.arange(2.0), one, np.arange(4.0), two, (False,) * 3, load_known=True)
    assert stretch.speeds[:, OUTPUTS['wheel_speed']].tolist() == [2.0, 5.0]
    assert stretch.torques[:, INPUTS['clutch_torque']].tolist() == [1.0, 4.0, 7.0, 10.0]
    assert stretch.slip.tolist() == [-1.0, -1.0]


@pytest.mark.parametrize('held', [(), OWN_HELD], ids=['of a car', 'of our plant'])
def test_a_computed_load_is_held_between_samples_in_a_log_of_our_plant_alone(
    held: tuple[str, ...],
) -> None:
    """C_f is sampled ten times as often as the speeds, so that the grid has steps of 1 ms."""
    rows = np.arange(601)
    ticks = np.where(rows % 10 == 0, rows, np.nan)
    signals = dict.fromkeys((*SPEEDS, 'engine_torque'), ticks) | {'clutch_torque': rows + 0.0}
    log = MeasuredLog(Path('drive.csv'), '', 0.001 * rows, signals, held)
    (found,) = stretches_of(log, lambda wheels: 2.0 * wheels)
    inside = (found.grid_s >= -1e-9) & (found.grid_s < 0.5999)
    expected = 2.0 * (10 * (rows[:600] // 10) if held else rows[:600])
    assert np.allclose(found.torques[inside, INPUTS['load_torque']], expected, rtol=0.0, atol=1e-6)
    assert found.held == (bool(held), False, bool(held))


def test_bags_and_csv_of_ours_have_the_same_held_quantities() -> None:
    assert own_columns('time').held == OWN_HELD == ('engine_torque', 'load_torque')
