# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Logs in which a node warns outlive a run that ended well; nothing else does."""

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from ddct_bringup.run import execution
from ddct_bringup.run.execution import execute, kept_logs
from ddct_bringup.run.plan import RunPlan
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

QUIET = '[INFO] [1.0] [load]: started\nnothing of note, [ERROR] in the middle of a line\n'
WITH_ERROR = '[INFO] [1.0] [actuator]: x\n[ERROR] [2.0] [actuator]: safe state\n'
WITH_WARNING = '[WARN] [1.0] [clutch]: clutch/torque counts as missing\n'


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Path]:
    """Return a function that carries out a run whose nodes print these logs."""

    def run_with(**logs: str) -> Path:
        monkeypatch.setattr(
            execution, '_execute_processes', lambda _plan, _folder, work, *_: _leave(work, logs)
        )
        execute(RunPlan(RunSettings(KnownSettings(load_scenario('thesis'))), 'ls8'), tmp_path)
        return tmp_path

    return run_with


def _leave(work: Path, logs: Mapping[str, str]) -> None:
    (work / 'parameters.yaml').write_text('[ERROR]\n', encoding='utf-8')
    for name, text in logs.items():
        (work / f'{name}.log').write_text(text, encoding='utf-8')


@pytest.mark.process
def test_logs_with_a_warning_or_an_error_stay(run: Callable[..., Path]) -> None:
    folder = run(load=QUIET, clutch=WITH_WARNING, actuator=WITH_ERROR)
    logs = [folder / 'work' / 'actuator.log', folder / 'work' / 'clutch.log']
    assert kept_logs(folder) == logs
    assert sorted((folder / 'work').iterdir()) == logs


@pytest.mark.process
def test_without_a_warning_nothing_stays(run: Callable[..., Path]) -> None:
    folder = run(load=QUIET, clutch=QUIET)
    assert kept_logs(folder) == []
    assert list(folder.iterdir()) == []
