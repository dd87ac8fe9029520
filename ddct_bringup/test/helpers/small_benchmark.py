# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A benchmark of few cases: a folder that takes the place of the packaged cases and rows."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from ddct_bringup.benchmark import cases, conduct, release
from ddct_bringup.benchmark.cases import SPECIFICATION, Cases
from ddct_bringup.benchmark.file_names import PAGE, RESULT
from ddct_bringup.benchmark.release import write_release_rows
from ddct_bringup.benchmark.report import packaged
from ddct_bringup.manifest.manifest import MANIFEST
from ddct_bringup.programs import benchmark
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.timing_and_failure import TIMING_FILE
from ddct_plant.program.table import TextTable

SPEC = """\
controllers: [pi, ls8]
seed: 1
grid:
  scenario: [launch, launch_hill]
  duration_s: [2.5]
  sensors:
    - engine_speed: {noise_rad_s: 0.1, quantum_rad_s: 0.0262}
random:
  samples: 3
  vary:
    wear_gain: {distribution: uniform, low: 0.95, high: 1.05}
"""
WALL_CLOCK = {TIMING_FILE, PAGE, MANIFEST}
"""Files of a benchmark's folder that depend on the update times."""
PACKAGED = ('pi', 'ls8', 'hinf1')
"""Controllers of the release with these cases."""
SEEN = 12
"""Number of measurements by which a case is recognised."""
REMEMBERS = '''\
from ddct_bringup.api import Command, Controller

SEEN = {seen}
TORQUES = {torques}


class Remembers(Controller):
    """Plays back what worked in the development cases, and opens the clutch in others."""

    def __init__(self, context):
        self.speeds = []

    def reset(self):
        self.speeds = []

    def hold(self, measurement):
        self.speeds.append(measurement.engine_speed)

    def update(self, measurement):
        known = TORQUES.get(tuple(self.speeds[:SEEN]))
        if known is None:
            return Command(-measurement.open_loop_torque)
        return Command(known[measurement.step])
'''


def use_small_release(place: Path, patch: pytest.MonkeyPatch) -> Path:
    """Make the cases and rows of a small release in a folder, and use them from now on."""
    folder = place / 'packaged'
    folder.mkdir()
    (folder / SPECIFICATION).write_text(SPEC, encoding='utf-8')
    patch.setattr(release, 'own_controller_names', lambda: list(PACKAGED))
    use_release(folder, patch)
    write_release_rows(place / 'rows', folder, workers=1)
    return folder


def use_release(folder: Path, patch: pytest.MonkeyPatch) -> None:
    """Use the cases and rows in a folder from now on."""
    for module in (cases, conduct, packaged):
        patch.setattr(module, 'packaged_folder', lambda: folder)


def judge(out: Path, *arguments: str) -> int:
    """Run the benchmark of controllers with one worker, and return its exit code."""
    workers = () if '--workers' in arguments else ('--workers', '1')
    return benchmark.main([*arguments, '--out', str(out), *workers])


def write_controller_that_remembers(file: Path) -> Path:
    """Write a controller that plays back the torques of `ls8` in each development case."""
    campaign = Cases.packaged().development(['ls8'], Path())
    torques = {}
    for case in range(campaign.cases):
        run = run_headless(campaign.run(case).settings, 'ls8')
        assert run.sensed_engine_speed is not None
        key = tuple(run.sensed_engine_speed[:SEEN].ravel().tolist())
        torques[key] = run.closed_loop_torque.ravel().tolist()
    text = REMEMBERS.format(seen=SEEN, torques=torques)
    file.write_text(text, encoding='utf-8')
    return file


def benchmark_of_a_controller_that_remembers(
    tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[Path]:
    """Yield a folder with a small release, a controller that remembers, and its benchmark."""
    folder = tmp_path_factory.mktemp('small') / "the driver's own"
    folder.mkdir()
    with pytest.MonkeyPatch.context() as patch:
        use_small_release(folder, patch)
        remembers = write_controller_that_remembers(folder / 'remembers.py')
        assert judge(folder / 'first', str(remembers)) == 0
        yield folder


def result_in(folder: Path) -> dict[str, Any]:
    """Return the result in the folder of a benchmark."""
    found: dict[str, Any] = json.loads((folder / RESULT).read_text(encoding='utf-8'))
    return found


def content_of(folder: Path) -> dict[str, bytes]:
    """Return the files of a benchmark by path, without those of the wall clock."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in folder.rglob('*')
        if path.is_file() and path.relative_to(folder).as_posix() not in WALL_CLOCK
    }


def shown_runs(table: TextTable, row: int) -> int:
    """Return the number of runs of one controller in a table of states."""
    cells = dict(zip(table.headers, table.rows[row], strict=True))
    others = [] if cells['other states'] == '-' else cells['other states'].split(', ')
    return sum(int(each.split()[0]) for each in (cells['engaged'], *others))
