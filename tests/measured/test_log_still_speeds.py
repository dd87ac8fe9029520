# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A speed that does not vary in the held-out data has no NRMSE, and the reason is shown."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from support.logs import drag
from support.other_car import drive
from support.runs import plan, record

from ddct_bringup.identification.from_log.command import NEEDED
from ddct_bringup.identification.from_log.fit import fit_log
from ddct_bringup.identification.from_log.prediction import predict
from ddct_bringup.identification.from_log.result import LogFit
from ddct_bringup.identification.from_log.stretches import stretches_of
from ddct_bringup.identification.identify import main
from ddct_bringup.logs.columns import TIME, own_columns
from ddct_bringup.logs.log import SPEEDS, MeasuredLog, read_log
from ddct_bringup.scores.csv_text import signals_csv
from ddct_plant.models.parameters import DrivelineParameters

STEP_RAD_S = 0.1
"""Resolution of a coarse sensor."""


@pytest.fixture(scope='module')
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the CSV log of a run whose clutch is locked from 1.2 s on."""
    folder = tmp_path_factory.mktemp('locked')
    run = plan('ls8', 'headless', duration_s=3.0, scenario='thesis_sticking')
    (folder / 'ls8.csv').write_text(signals_csv(record(run, folder / 'ls8')))
    return folder / 'ls8.csv'


@pytest.fixture(scope='module')
def log(file: Path) -> MeasuredLog:
    return read_log(file, own_columns(TIME, *NEEDED), NEEDED)


@pytest.fixture(scope='module')
def fit(log: MeasuredLog) -> LogFit:
    return fit_log(_changed(log.part(0.0, 2.1), 'noise'), DrivelineParameters(), drag)


def _changed(log: MeasuredLog, kind: str) -> MeasuredLog:
    """Return a log with the noise or the resolution of sensors."""
    random, signals = np.random.default_rng(3), dict(log.signals)
    for name in SPEEDS:
        if kind == 'noise':
            signals[name] = signals[name] + 0.05 * random.standard_normal(len(log.time_s))
        else:
            signals[name] = STEP_RAD_S * np.round(signals[name] / STEP_RAD_S)
    if kind == 'one step':
        signals['engine_speed'][-20:] += STEP_RAD_S
    return replace(log, signals=signals)


@pytest.mark.parametrize(
    ('kind', 'reason'),
    [
        ('noise', 'is not beyond its noise'),
        ('resolution', 'it is constant'),
        ('one step', 'is not beyond its resolution'),
    ],
)
def test_a_slip_of_zero_has_no_nrmse_whatever_the_sensors(
    log: MeasuredLog, fit: LogFit, kind: str, reason: str
) -> None:
    held_out = _changed(log.part(2.1, 3.0), kind)
    found = {each.signal: each for each in predict(fit, stretches_of(held_out, drag))}
    assert found['slip_speed'].nrmse is None
    assert found['slip_speed'].no_nrmse is not None
    assert found['slip_speed'].no_nrmse.endswith(reason)
    for name in SPEEDS:
        assert found[name].no_nrmse is None
        assert found[name].nrmse is not None


def test_a_slip_that_varies_less_than_it_matters_has_no_nrmse(
    log: MeasuredLog, fit: LogFit
) -> None:
    signals = dict(log.part(2.1, 3.0).signals)
    swing = 1e-3 * np.sin(np.linspace(0.0, 12.0, len(signals['engine_speed'])))
    for size, varies in ((1.0, False), (100.0, True)):
        moved = {**signals, 'engine_speed': signals['engine_speed'] + size * swing}
        held_out = replace(log.part(2.1, 3.0), signals=moved)
        (slip,) = predict(fit, stretches_of(held_out, drag))[3:]
        assert (slip.nrmse is not None) == varies
        assert (slip.no_nrmse is None) == varies


def test_the_reason_is_in_the_output(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    report = file.with_name('fit.json')
    assert main(['--from', str(file), '--force', '--json', str(report)]) == 0
    content = json.loads(report.read_text())
    slip = content['held_out']['signals'][3]
    assert (slip['nrmse'], slip['no_nrmse']) == (None, 'it is constant')
    printed = capsys.readouterr().out
    assert 'Note: the held-out slip_speed has no NRMSE: it is constant.' in printed
    assert all(each['no_nrmse'] is None for each in content['held_out']['signals'][:3])


def test_a_slip_that_varies_beyond_its_noise_has_an_nrmse() -> None:
    whole = MeasuredLog(Path('a.csv'), '', drive().time_s, drive().noisy(0))
    fit = fit_log(whole.part(0.0, 3.4), DrivelineParameters(), drag)
    found = predict(fit, stretches_of(whole.part(3.4, 4.8), drag))
    assert all(each.nrmse is not None and each.no_nrmse is None for each in found)
