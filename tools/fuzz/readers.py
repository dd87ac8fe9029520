# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Readers of files and connections from users and strangers, each with good inputs.

Other inputs are made of those.

No target are files that are run (controllers in Python, libraries in C), files that are only
searched for a mark or compared byte by byte (exports, pages, `metadata.yaml`), lock files, and
what the packages contain.
"""

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as parquet
from support.runs import plan

from ddct_bringup.campaign.arrow_columns import read_parquet
from ddct_bringup.logs.columns import load_columns
from ddct_bringup.verdict.limits import load_limits
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.file import ScenarioFile, load_scenario, scenario_to_yaml
from fuzz.reader import Reader
from fuzz.targets.bag_readers import bag_readers, made_bag
from fuzz.targets.benchmark_readers import benchmark_readers
from fuzz.targets.campaign_readers import campaign_readers
from fuzz.targets.controller_readers import controller_readers
from fuzz.targets.floor_readers import floor_reader
from fuzz.targets.live_readers import frames, read_frames
from fuzz.targets.run_readers import run_readers
from fuzz.targets.tuning_readers import tuning_readers

ROOT = Path(__file__).resolve().parents[2]
_PROFILE = b't,torque\n0.0,0.0\n0.5,120.5\n1.5e0,240\n'
_PACKAGED = 'ddct_plant/ddct_plant/scenario/packaged'
_VERDICT = 'ddct_bringup/ddct_bringup/verdict'


def readers(folder: Path) -> dict[str, Reader]:
    """Return all readers by name; their good inputs are made in a folder."""
    run = plan('pi', 'headless', duration_s=0.8, changes=('score_window_s=[0.6, 0.8]',))
    bag = made_bag(folder, run)
    scenario = scenario_to_yaml(load_scenario('thesis')).encode()
    packaged = _texts(f'{_PACKAGED}/scenarios/*.yaml')
    found = [
        *bag_readers(bag, folder),
        *controller_readers(),
        *run_readers(bag, folder),
        *campaign_readers(folder),
        *benchmark_readers(folder),
        floor_reader(folder),
        *tuning_readers(folder),
        Reader('scenario', 'mine.yaml', _scenario, (scenario, *packaged)),
        Reader('car', 'car.yaml', _car, _texts(f'{_PACKAGED}/cars/*.yaml')),
        Reader('drive', 'drive.yaml', _drive, _texts(f'{_PACKAGED}/drives/*.yaml')),
        Reader('profile', 'pedal.csv', _profile, (_PROFILE, _PROFILE.replace(b',', b'; '))),
        Reader('limits', 'limits.yaml', load_limits, _texts(f'{_VERDICT}/limits.yaml')),
        Reader('columns', 'map.yaml', _columns, _texts('docs/use/own_car_columns.yaml')),
        Reader('parquet', 'results.parquet', _table, (_parquet(folder),)),
        Reader('live_frames', 'frames', read_frames, frames()),
    ]
    return {each.name: each for each in found}


def _columns(file: Path) -> object:
    return load_columns(str(file))


def _scenario(file: Path) -> object:
    return ScenarioFile.read(str(file)).scenario()


def _car(file: Path) -> object:
    """Load a car for a drive in N m that fits every packaged engine and both clutches."""
    engine = 'engine={time_s: [0.0], torque_n_m: [100.0]}'
    return load_scenario(car=str(file), drive='thesis', overrides=[engine])


def _drive(file: Path) -> object:
    return load_scenario(drive=str(file))


def _profile(file: Path) -> object:
    """Load a scenario whose torque of the engine is in a file."""
    section = f'{{csv: {file}, time: t, value: torque, unit: N m}}'
    return load_scenario('thesis', [f'engine={section}'])


def _table(file: Path) -> object:
    try:
        return read_parquet(file)
    except (OSError, pa.ArrowException) as error:
        raise DdctError(error) from error


def _texts(pattern: str) -> tuple[bytes, ...]:
    found = tuple(file.read_bytes() for file in sorted(ROOT.glob(pattern)))
    assert found, pattern
    return found


def _parquet(folder: Path) -> bytes:
    file = folder / 'table.parquet'
    columns = {'index': np.arange(20), 'jerk': np.linspace(0.0, 1.0, 20), 'reason': ['', 'x'] * 10}
    parquet.write_table(pa.table(columns), file, compression='zstd')
    return file.read_bytes()
