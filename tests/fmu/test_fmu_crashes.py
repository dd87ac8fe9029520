# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""An FMU that ends, crashes or stops its process ends its own run alone, with one line."""

import os
import signal
import subprocess
import sys

import pytest
from refusals import refused
from support.fmu import (
    ABORT,
    CRASH,
    EXIT,
    GAINS,
    LOAD_FAULT,
    LOOP,
    controller_file,
    faulty,
    unpacked,
)
from support.waiting import wait_until

from ddct_bringup.run.headless import run_headless
from ddct_controllers.from_file.foreign import loaded
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

pytestmark = pytest.mark.usefixtures('folder')
SETTINGS = RunSettings(load_scenario('thesis', ['duration_s=1', GAINS]))
ENDS = {
    EXIT: 'it ended with exit code 0',
    ABORT: 'it crashed (SIGABRT)',
    CRASH: 'it crashed (SIGSEGV)',
    LOOP: 'it gave no answer within 2 s',
}
PLACE = 'controller file mine.yaml: line 3'


def shorten_calls(fault: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let an FMU that never answers be ended soon."""
    if fault == LOOP:
        monkeypatch.setattr(loaded, 'MOST_SECONDS', 2)


@pytest.mark.parametrize(('version', 'fault'), [(2, EXIT), (3, ABORT), (2, LOOP)])
def test_the_end_of_its_process_in_a_run_is_one_line_with_its_name(
    version: int, fault: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    shorten_calls(fault, monkeypatch)
    with refused(DdctError, 'fmu.file', place=PLACE) as raised:
        run_headless(SETTINGS, faulty(version, fault))
    assert f'pi.fmu failed at its own time 0.1 s ({ENDS[fault]})' in str(raised.value)
    del raised  # the error refers to the controller, which has processes
    assert unpacked() == []


@pytest.mark.parametrize('fault', [CRASH])
def test_the_end_of_its_process_at_the_start_is_one_line_with_its_name(
    fault: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    shorten_calls(fault, monkeypatch)
    monkeypatch.setenv(LOAD_FAULT, str(fault))
    with refused(DdctError, 'fmu.file', place=PLACE) as raised:
        make_controller(controller_file(2), SETTINGS)
    assert f'pi.fmu failed when it is loaded ({ENDS[fault]})' in str(raised.value)
    assert unpacked() == []


KILLED = """
import os, sys
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings
made = make_controller(sys.argv[1], RunSettings(load_scenario('thesis')))
assert os.listdir('tmp')
os.kill(os.getpid(), 9)
"""
"""Program that is killed while it has a controller of an FMU."""


def test_a_killed_program_leaves_no_process_and_no_folder() -> None:
    environment = {**os.environ, 'PYTHONPATH': os.pathsep.join(sys.path)}
    command = [sys.executable, '-c', KILLED, controller_file(2)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    # The pipe of standard error ends with the last process that has it, so all have ended.
    assert done.returncode == -signal.SIGKILL, done.stderr
    assert unpacked() == []


def test_the_folder_of_a_killed_process_is_removed() -> None:
    made = make_controller(controller_file(2), SETTINGS)
    assert len(unpacked()) == 1
    os.kill(made._process.pid, signal.SIGKILL)  # type: ignore[attr-defined]
    wait_until(lambda: not unpacked(), 'the folder is there')
