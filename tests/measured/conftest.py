# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A log of another car with its column map, in a folder; fits without their progress."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest
from support.other_car import COLUMNS, drive, write_csv

from ddct_bringup.identification.from_log import command
from ddct_bringup.identification.from_log.fit import fit_log
from ddct_bringup.identification.from_log.result import LogFit
from ddct_bringup.identification.from_log.stretches import KnownLoad
from ddct_bringup.logs.log import MeasuredLog
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.program import progress


@pytest.fixture(autouse=True)
def no_progress(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have no progress printed: on a busy machine a fit takes long enough for it."""
    monkeypatch.setattr(progress, '_QUIET_S', math.inf)


@pytest.fixture(scope='module')
def each_fit_once() -> Iterator[None]:
    """Have `identify` fit equal logs in the same way once in the tests of a file."""
    found: dict[tuple[object, ...], LogFit] = {}

    def fit_once(
        log: MeasuredLog,
        start: DrivelineParameters,
        known_load: KnownLoad,
        fixed: Sequence[str],
        known_delays: Mapping[str, float],
        evaluated: Callable[[], None],
    ) -> LogFit:
        values = [(name, each.tobytes()) for name, each in log.signals.items()]
        load = known_load(np.linspace(0.0, 60.0)).tobytes()
        key = (log.time_s.tobytes(), *values, log.held, start, load)
        key += (*fixed, *known_delays.items())
        if key not in found:
            found[key] = fit_log(log, start, known_load, fixed, known_delays, evaluated)
        return found[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(command, 'fit_log', fit_once)
        yield


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with `drive.csv` and its column map `map.yaml`."""
    (tmp_path / 'map.yaml').write_text(COLUMNS)
    write_csv(tmp_path / 'drive.csv', 3, drive(1))
    return tmp_path
