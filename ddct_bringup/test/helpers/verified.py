# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Results to verify: runs and a campaign, and edits of them together with their digests."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as parquet
import pytest
from by_schema import require_schema
from drawn_charts import leave_out_time_charts
from drawn_here import draw_here

from ddct_bringup.campaign.conduct import RESULTS, SHARDS
from ddct_bringup.campaign_report import document
from ddct_bringup.manifest.manifest import (
    MANIFEST,
    Manifest,
    file_digest,
    finish_manifest,
    read_manifest,
)
from ddct_bringup.programs import bringup, campaign, compare, verify
from ddct_plant.files.json_records import from_json

SPEC = """\
controllers: [{controller}]
scenario: thesis_sticking
seed: 3
grid: {{wear_gain: [0.8, 1.0], duration_s: [0.7]}}
random:
  samples: 1
  vary:
    vehicle.mass_kg: {{distribution: uniform, low: 1000, high: 2000}}
"""
CONTROLLER = """\
from ddct_bringup.api import Command, Controller


class Mine(Controller):
    def reset(self):
        pass

    def update(self, measurement):
        return Command(-0.1 * measurement.slip_error_rpm)
"""
HANDOVER = """\
from ddct_controllers.handover.laws import TimedHandover


class Mine(TimedHandover):
    pass
"""


DRAWN = document._charts
"""The charts of the page of a campaign, where they are left out."""


def leave_out_charts(patch: pytest.MonkeyPatch) -> None:
    """Draw no chart on pages of runs and campaigns, which takes most of the time of small ones."""
    draw_here(patch)
    leave_out_time_charts(patch)
    patch.setattr('ddct_bringup.report.page.pareto_view', lambda runs: None)
    patch.setattr(document, '_charts', lambda *_: iter(()))


def make_runs(out: Path, controllers: str = 'pi,mpc3', *options: str) -> Path:
    """Compare controllers headless for a short time, and return the folder."""
    given = ['--controllers', controllers, '--duration', '0.8', '--headless', '--out', str(out)]
    assert compare.main([*given, *options]) == 0
    return out


def make_bag(out: Path, *options: str) -> Path:
    """Run one controller headless for a short time, and return the folder around its bag."""
    assert bringup.main(['--duration', '0.8', '--headless', '--out', str(out), *options]) == 0
    return out


def make_small_campaign(place: Path, controller: str = 'ls8') -> Path:
    """Carry out a campaign of two rows, and return its folder."""
    place.mkdir(exist_ok=True)
    spec = SPEC.format(controller=controller)
    (place / 'spec.yaml').write_text(spec, encoding='utf-8')
    out = place / 'campaign'
    assert campaign.main([str(place / 'spec.yaml'), '--out', str(out), '--workers', '1']) == 0
    return out


def copied(folder: Path, to: Path) -> Path:
    """Return a copy of a result."""
    shutil.copytree(folder, to)
    return to


def edit_with_digest(folder: Path, name: str, content: bytes) -> None:
    """Replace a file of a result, and its digest too."""
    (folder / name).write_bytes(content)
    manifest = read_manifest(folder)
    manifest.with_files({name: file_digest(folder / name)}).write(folder)


def edit_manifest(folder: Path, edit: Callable[[Any], None]) -> None:
    """Edit the content of the manifest of a result, and its own digest."""
    content = json.loads((folder / MANIFEST).read_text(encoding='utf-8'))
    edit(content)
    from_json(Manifest, content, folder).write(folder)


def edit_json_with_digest(folder: Path, name: str, edit: Callable[[Any], None]) -> None:
    """Edit the content of a JSON file of a result, and its digest too."""
    content = json.loads((folder / name).read_text(encoding='utf-8'))
    edit(content)
    edit_with_digest(folder, name, (json.dumps(content, indent=2) + '\n').encode())


def edit_rows(folder: Path, name: str, edit: Callable[[list[Any]], list[Any]]) -> None:
    """Edit a column of the results and of the shards, and their digests too."""
    for file in (folder / RESULTS, *sorted((folder / SHARDS).iterdir())):
        table = parquet.read_table(file)
        place = table.column_names.index(name)
        values = edit(table[name].to_pylist())
        column = pa.array(values, table.schema.field(place).type)
        parquet.write_table(table.set_column(place, table.schema.field(place), column), file)
    finish_manifest(folder)


def of_another_release(folder: Path) -> None:
    """Give the manifest of a result the code of another release."""
    manifest = read_manifest(folder)
    replace(manifest, origin=replace(manifest.origin, code='f' * 64)).write(folder)


def verified(
    folder: Path, capfd: pytest.CaptureFixture[str], *options: str
) -> tuple[int, dict[str, Any], str]:
    """Return exit code, JSON and standard error of `verify`."""
    capfd.readouterr()
    code = verify.main([str(folder), '--json', '-', *options])
    printed = capfd.readouterr()
    document = json.loads(printed.out) if printed.out else {}
    if document:
        require_schema('verify_several' if 'folders' in document else 'verify', document)
    return code, document, printed.err


def states(document: dict[str, Any]) -> dict[str, str]:
    """Return the states of the runs by name."""
    return {run['run']: run['state'] for run in document['runs']}


def verified_on_other_kernels(folder: Path) -> subprocess.CompletedProcess[str]:
    """Verify a folder in a process with other kernels of OpenBLAS."""
    if 'OpenBLAS' not in read_manifest(folder).arithmetic.blas:
        pytest.skip('numpy has no OpenBLAS here')
    path = ':'.join(sys.path)
    return subprocess.run(
        [sys.executable, '-m', verify.__name__, str(folder), '--json', '-'],
        env={**os.environ, 'OPENBLAS_CORETYPE': 'Prescott', 'PYTHONPATH': path},
        capture_output=True,
        text=True,
        check=False,
    )
