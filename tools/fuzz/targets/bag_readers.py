# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Readers of bags, with bags of one clutch, of a gear shift, with sensors and of real time."""

import tempfile
from collections.abc import Iterator
from pathlib import Path

from support.runs import plan
from support.sensors import ALL_ON

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.logs.columns import own_columns
from ddct_bringup.logs.log import read_log
from ddct_bringup.run.execution import execute
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.csv_text import signals_csv
from fuzz.reader import Reader

NAME = 'pi.mcap'
_REAL_TIME = Path(__file__).resolve().parents[1] / 'real_time' / 'pi_0.mcap'
"""A bag of real time: to record one takes a graph."""


def bag_readers(bag: Path, folder: Path) -> list[Reader]:
    """Return the readers of bags; `bag` is the first good one, others are made in a folder."""
    files = (bag, *(made_bag(folder, run) for run in _further()), _REAL_TIME)
    bags = tuple(file.read_bytes() for file in files)
    unfinished = tuple(each[:-4000] for each in bags)
    log = signals_csv(read_bag(bag)).encode()[:30_000].rpartition(b'\n')[0]
    return [
        Reader('bag', NAME, _digest, bags, exact=True),
        Reader('bag_as_log', NAME, _log_of_bag, bags, exact=True),
        Reader('unfinished_bag', NAME, _steps, unfinished),
        Reader('log', 'log.csv', _log, (log,)),
    ]


def made_bag(folder: Path, run: RunPlan) -> Path:
    """Return the bag of a run, in a new folder below `folder`."""
    place = Path(tempfile.mkdtemp(dir=folder))
    execute(run, place)
    (file,) = place.glob('*.mcap')
    return file


def _further() -> Iterator[RunPlan]:
    """Yield a gear shift, in which two clutches act, and a run with sensors."""
    yield plan(
        *('pi', 'headless'),
        scenario='upshift',
        duration_s=0.6,
        changes=('score_window_s=[0.3, 0.6]',),
    )
    yield plan(*('pi', 'headless'), duration_s=0.7, changes=(ALL_ON, 'score_window_s=[0.6, 0.7]'))


def _digest(file: Path) -> object:
    return read_bag(file).trajectory.sha256()


def _log_of_bag(file: Path) -> object:
    log = read_log(file, own_columns())
    return {name: values.tobytes() for name, values in log.signals.items()}


def _steps(file: Path) -> object:
    return read_bag(file).trajectory.steps


def _log(file: Path) -> object:
    return read_log(file, own_columns('time', 'engine_speed', 'engine_torque'))
