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
from waiting import WITHIN_S

from ddct_bringup.run.headless import run_headless
from ddct_controllers.from_file.fmu import instance
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import DdctError
from ddct_plant.program import own_process
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

pytestmark = pytest.mark.usefixtures('folder')
SETTINGS = RunSettings(KnownSettings(load_scenario('thesis', ['duration_s=1', GAINS])))
ENDS = {
    EXIT: 'it ended with exit code 0',
    ABORT: 'it crashed (SIGABRT)',
    CRASH: 'it crashed (SIGSEGV)',
    LOOP: 'it gave no answer within 1 s',
}
PLACE = 'controller file mine.yaml: line 3'


@pytest.fixture(autouse=True)
def soon(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let an FMU that never answers be ended soon."""
    monkeypatch.setattr(own_process, '_MOST_SECONDS', 1)


@pytest.mark.parametrize(('version', 'fault'), [(2, EXIT), (3, ABORT), (2, LOOP), (3, CRASH)])
def test_the_end_of_its_process_in_a_run_is_one_line_with_its_name(
    version: int, fault: int
) -> None:
    with refused(DdctError, 'fmu.file', place=PLACE) as raised:
        run_headless(SETTINGS, faulty(version, fault))
    assert f'pi.fmu: {ENDS[fault]} when update was called at step 70: mend' in str(raised.value)
    assert unpacked() == set()


def test_the_end_of_its_process_at_the_start_is_one_line_with_its_name(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv(LOAD_FAULT, str(CRASH))
    with refused(DdctError, 'fmu.file', place=PLACE) as raised:
        run_headless(SETTINGS, controller_file(2))
    assert f'pi.fmu: {ENDS[CRASH]} when it was loaded: mend it' in str(raised.value)
    assert unpacked() == set()


def test_a_crash_while_it_is_freed_comes_after_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    file = controller_file(2)
    expected = run_headless(SETTINGS, file)
    monkeypatch.setattr(instance, '_end', lambda *_: os.abort())
    assert run_headless(SETTINGS, file).sha256() == expected.sha256()


KILLED = """
import os, sys, time
from ddct_controllers.from_file.fmu import instance
from ddct_controllers.registry import make_controller, separately
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings

def work(chosen):
    made = make_controller(chosen, KnownSettings(load_scenario('thesis')))
    assert os.listdir('tmp')
    os.kill(os.getppid(), 9)
    time.sleep(60)

separately(sys.argv[1], work)
"""
"""Program that is killed while an FMU runs."""


def test_a_killed_program_leaves_no_process_and_the_next_run_removes_its_folder() -> None:
    environment = {**os.environ, 'PYTHONPATH': os.pathsep.join(sys.path)}
    command = [sys.executable, '-c', KILLED, controller_file(2)]
    done = subprocess.run(
        command, env=environment, capture_output=True, text=True, check=False, timeout=WITHIN_S
    )
    # The pipe of standard error ends with the last process that has it, so all have ended.
    assert done.returncode == -signal.SIGKILL, done.stderr
    assert len(unpacked()) == 1
    kept = make_controller(controller_file(3), SETTINGS.known)
    assert len(unpacked()) == 1, 'it is that of the killed program, or another one too'
    run_headless(SETTINGS, controller_file(2))
    assert len(unpacked()) == 1, 'a folder in use is gone'
    del kept
    assert unpacked() == set()
