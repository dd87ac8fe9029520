# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Readers of files and connections from users and strangers, each with good inputs.

Other inputs are made of those.
"""

import io
from contextlib import redirect_stdout
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as parquet
from fuzz.bag_readers import bag_readers, made_bag
from fuzz.controller_readers import controller_readers
from fuzz.live_readers import frames, heads, read_frames, read_head
from fuzz.reader import Read, Reader
from fuzz.tuning_readers import tunings
from support.runs import plan

from ddct_bringup.campaign.arrow_columns import read_parquet
from ddct_bringup.campaign.manifest import MANIFEST, Manifest
from ddct_bringup.campaign.spec import read_spec
from ddct_bringup.digests.digest_file import DIGESTS, RUNS, Digests, read_digests
from ddct_bringup.digests.environment import this_environment
from ddct_bringup.programs.score import main as score
from ddct_bringup.run.timing_and_failure import (
    NOTE_FILE,
    TIMING_FILE,
    RunTiming,
    failed_run,
    read_timing,
)
from ddct_bringup.scores.document import read_scores
from ddct_bringup.verdict.limits import load_limits
from ddct_plant.base.errors import DdctError
from ddct_plant.measured.columns import load_columns
from ddct_plant.scenario.file import ScenarioFile, load_scenario, scenario_to_yaml

ROOT = Path(__file__).resolve().parents[2]
_VERDICT = 'ddct_bringup/ddct_bringup/verdict'
_MANIFEST = (
    b'{"schema_version": 1, "root_seed": 0, "version": "0.1", "commit": "unknown", '
    b'"code_digest": "a", "spec_digest": "b", "limits": {"name": "x"}, "runs": 8, '
    b'"shard_size": 1, "folder": "/tmp", "spec": {"controllers": ["pi"], '
    b'"grid": {"wear_gain": [0.7]}, "random": {"samples": 2, "vary": {}}}}'
)


def readers(folder: Path) -> dict[str, Reader]:
    """Return all readers by name; their good inputs are made in a folder."""
    run = plan('pi', 'headless', duration_s=0.8, changes=('score_window_s=[0.6, 0.8]',))
    bag = made_bag(folder, run)
    scenario = scenario_to_yaml(load_scenario('thesis')).encode()
    packaged = _texts('ddct_plant/ddct_plant/scenario/packaged/*.yaml')
    note = b'{"reason": "it stalled", "run": {"controller": "pi"}}'
    found = [
        *bag_readers(bag, folder),
        *controller_readers(),
        Reader('scenario', 'mine.yaml', _scenario, (scenario, *packaged)),
        Reader('limits', 'limits.yaml', load_limits, _texts(f'{_VERDICT}/limits.yaml')),
        Reader('campaign', 'mine.yaml', read_spec, _texts('docs/templates/campaign.yaml')),
        Reader('columns', 'map.yaml', _columns, _texts('docs/use/own_car_columns.yaml')),
        Reader('parquet', 'results.parquet', _table, (_parquet(folder),)),
        Reader('manifest', MANIFEST, _in_folder(Manifest.read), (_MANIFEST,)),
        Reader('timing', TIMING_FILE, _in_folder(read_timing), (_timing(folder),)),
        Reader('failed_run', NOTE_FILE, _in_folder(failed_run), (note,)),
        Reader('digests', DIGESTS, _in_folder(read_digests), (_digests(),)),
        Reader('scores', 'scores.json', read_scores, (_scores(bag, folder),)),
        *(Reader(f'tuning_{name}', 'mine.yaml', read, (text,)) for name, read, text in tunings()),
        Reader('live_head', 'head', read_head, heads()),
        Reader('live_frames', 'frames', read_frames, frames()),
    ]
    return {each.name: each for each in found}


def _in_folder(read: Read) -> Read:
    """Return a reader of a file whose folder `read` takes."""
    return lambda file: read(file.parent)


def _columns(file: Path) -> object:
    return load_columns(str(file))


def _scenario(file: Path) -> object:
    return ScenarioFile.read(str(file)).scenario()


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


def _timing(folder: Path) -> bytes:
    RunTiming(update_times_us=[1.0, 2.5], safe_states={'/clutch': 3}).write(folder)
    return (folder / TIMING_FILE).read_bytes()


def _digests() -> bytes:
    return Digests(1, RUNS, {'pi_0.mcap': 'ab'}, this_environment()).text().encode()


def _scores(bag: Path, folder: Path) -> bytes:
    with redirect_stdout(io.StringIO()):
        assert score([str(bag), '--json', str(folder / 'scores.json')]) in (0, 1)
    return (folder / 'scores.json').read_bytes()
