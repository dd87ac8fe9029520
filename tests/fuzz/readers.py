# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Readers of files and connections from users and strangers, each with good inputs.

Other inputs are made of those.

A reader returns, or raises DdctError in one line. Any other exception is a finding, and so are
printed text, and numbers of a damaged bag that differ from those of the good one.
"""

import io
import shutil
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as parquet
from fuzz.fmu_readers import DESCRIPTION, FMU, descriptions, fmus, read_description, read_fmu
from fuzz.live_readers import frames, heads, read_frames, read_head
from fuzz.tuning_readers import tunings

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.repair import repair_bag
from ddct_bringup.campaign.arrow_columns import read_parquet
from ddct_bringup.campaign.manifest import MANIFEST, Manifest
from ddct_bringup.campaign.spec import read_spec
from ddct_bringup.digests.digest_file import DIGESTS, RUNS, Digests, read_digests
from ddct_bringup.digests.environment import this_environment
from ddct_bringup.programs.score import main as score
from ddct_bringup.run.execution import execute
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.run.timing_and_failure import (
    NOTE_FILE,
    TIMING_FILE,
    RunTiming,
    failed_run,
    read_timing,
)
from ddct_bringup.scores.csv_text import signals_csv
from ddct_bringup.scores.document import read_scores
from ddct_bringup.verdict.limits import load_limits
from ddct_controllers.registry import controller_spec
from ddct_plant.base.errors import DdctError
from ddct_plant.measured.columns import load_columns, own_columns
from ddct_plant.measured.log import read_log
from ddct_plant.scenario.file import ScenarioFile, load_scenario, scenario_to_yaml
from ddct_plant.scenario.settings import RunSettings

ROOT = Path(__file__).resolve().parents[2]
LONGEST_LINE = 5000
_VERDICT = 'ddct_bringup/ddct_bringup/verdict'
_MANIFEST = (
    b'{"schema_version": 1, "root_seed": 0, "version": "0.1", "commit": "unknown", '
    b'"code_digest": "a", "spec_digest": "b", "limits": {"name": "x"}, "runs": 8, '
    b'"shard_size": 1, "folder": "/tmp", "spec": {"controllers": ["pi"], '
    b'"grid": {"wear_gain": [0.7]}, "random": {"samples": 2, "vary": {}}}}'
)
Read = Callable[[Path], object]
"""Function that reads a file, and returns what must not change where it accepts other bytes."""


@dataclass(frozen=True)
class Reader:
    """A reader of one kind of file."""

    name: str
    """Name of the reader, and of the folder of its corpus."""
    file: str
    """Name of the file that it reads."""
    read: Read
    seeds: tuple[bytes, ...]
    """Good inputs."""
    exact: bool = False
    """Whether an input made of the first good one must give what that gives."""

    def finding(self, data: bytes, folder: Path) -> str:
        """Return what is wrong with the reader's treatment of an input, '' for nothing."""
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        file = folder / self.file
        file.write_bytes(data)
        printed = io.StringIO()
        with redirect_stdout(printed), redirect_stderr(printed):
            what = self._finding(file)
        return what or (f'prints {printed.getvalue()!r}' if printed.getvalue() else '')

    def _finding(self, file: Path) -> str:
        try:
            found = self.read(file)
        except DdctError as error:
            text = str(error)
            return '' if text.isprintable() and len(text) < LONGEST_LINE else f'text {text!r}'
        except (Exception, SystemExit) as error:  # any other exception is the finding
            return f'{type(error).__name__}: {error}'
        if self.exact and found != self.expected(file.parent):
            return 'other numbers than those of the good input'
        return ''

    def expected(self, folder: Path) -> object:
        """Return what the first good input gives."""
        file = folder / f'good_{self.file}'
        file.write_bytes(self.seeds[0])
        return self.read(file)


def readers(folder: Path) -> dict[str, Reader]:
    """Return all readers by name; their good inputs are made in a folder."""
    bag = _bag(folder / 'good')
    scenario = scenario_to_yaml(load_scenario('thesis')).encode()
    whole = bag.read_bytes()
    log = signals_csv(read_bag(bag)).encode()[:30_000].rpartition(b'\n')[0]
    packaged = _texts('ddct_plant/ddct_plant/scenario/packaged/*.yaml')
    note = b'{"reason": "it stalled", "run": {"controller": "pi"}}'
    found = [
        Reader('bag', 'pi.mcap', _bag_digest, (whole,), exact=True),
        Reader('bag_as_log', 'pi.mcap', _log_of_bag, (whole,), exact=True),
        Reader('repair', 'pi.mcap', _repaired, (whole, whole[:-4000])),
        Reader('scenario', 'mine.yaml', _scenario, (scenario, *packaged)),
        Reader('limits', 'limits.yaml', load_limits, _texts(f'{_VERDICT}/limits.yaml')),
        Reader('campaign', 'mine.yaml', read_spec, _texts('docs/templates/campaign.yaml')),
        Reader('controller', 'mine.yaml', _controller, _texts('docs/templates/transfer*.yaml')),
        Reader('columns', 'map.yaml', _columns, _texts('docs/use/own_car_columns.yaml')),
        Reader('log', 'log.csv', _log, (log,)),
        Reader('parquet', 'results.parquet', _table, (_parquet(folder),)),
        Reader('manifest', MANIFEST, _in_folder(Manifest.read), (_MANIFEST,)),
        Reader('timing', TIMING_FILE, _in_folder(read_timing), (_timing(folder),)),
        Reader('failed_run', NOTE_FILE, _in_folder(failed_run), (note,)),
        Reader('digests', DIGESTS, _in_folder(read_digests), (_digests(),)),
        Reader('scores', 'scores.json', read_scores, (_scores(bag, folder),)),
        *(Reader(f'tuning_{name}', 'mine.yaml', read, (text,)) for name, read, text in tunings()),
        Reader('fmu_description', DESCRIPTION, read_description, descriptions()),
        Reader('fmu', FMU, read_fmu, fmus()),
        Reader('live_head', 'head', read_head, heads()),
        Reader('live_frames', 'frames', read_frames, frames()),
    ]
    return {each.name: each for each in found}


def _bag(folder: Path) -> Path:
    folder.mkdir(parents=True)
    settings = RunSettings(
        load_scenario('thesis', ['duration_s=0.8', 'score_window_s=[0.6, 0.8]'])
    )
    execute(RunPlan(settings, 'pi', 'headless'), folder)
    (file,) = folder.glob('*.mcap')
    return file


def _in_folder(read: Read) -> Read:
    """Return a reader of a file whose folder `read` takes."""
    return lambda file: read(file.parent)


def _bag_digest(file: Path) -> object:
    return read_bag(file).trajectory.sha256()


def _controller(file: Path) -> object:
    return controller_spec(str(file))


def _columns(file: Path) -> object:
    return load_columns(str(file))


def _log_of_bag(file: Path) -> object:
    log = read_log(file, own_columns())
    return {name: values.tobytes() for name, values in log.signals.items()}


def _repaired(file: Path) -> object:
    repair_bag(file)
    return read_bag(file).trajectory.steps


def _scenario(file: Path) -> object:
    return ScenarioFile.read(str(file)).scenario()


def _log(file: Path) -> object:
    return read_log(file, own_columns('time', 'engine_speed', 'engine_torque'))


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
