# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What a real-time run asks of the kernel is given to every thread, or refused with its name."""

import os
import subprocess
import sys
from threading import Event, Thread

import pytest
from refusals import refused

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.program.scheduling import Scheduling, cpus_in, scheduling_restored

pytestmark = pytest.mark.slow

CORES = sorted(os.sched_getaffinity(0))
LOCKED = (
    'from ddct_plant.program.scheduling import Scheduling, scheduling_restored\n'
    'locked = lambda: int(next(line.split()[1] for line in open("/proc/self/status")'
    ' if line.startswith("VmLck")))\n'
)
"""Begin of a program: `locked()` is its locked memory in kB."""


def permitted(**options):
    """Return the scheduling, or skip the test where this user may not ask for it."""
    scheduling = Scheduling(**options)
    try:
        scheduling.require_permitted()
    except DdctError as error:
        pytest.skip(str(error))
    return scheduling


@pytest.fixture
def other_thread():
    """Yield the id of a thread that was there before."""
    go = Event()
    thread = Thread(target=go.wait, args=[60.0])
    thread.start()
    yield thread.native_id
    go.set()
    thread.join()


def test_the_priority_is_that_of_every_thread_until_it_is_taken_back(other_thread):
    scheduling = permitted(realtime_priority=3)
    before = os.sched_getscheduler(0)
    with scheduling_restored():
        scheduling.apply()
        for thread in (0, other_thread):
            assert os.sched_getscheduler(thread) == os.SCHED_FIFO
            assert os.sched_getparam(thread).sched_priority == 3
    assert os.sched_getscheduler(0) == os.sched_getscheduler(other_thread) == before


def test_the_cores_are_those_of_every_thread_until_they_are_taken_back(other_thread):
    before = os.sched_getaffinity(0)
    with scheduling_restored():
        Scheduling(cpus=str(CORES[0])).apply()
        assert os.sched_getaffinity(0) == os.sched_getaffinity(other_thread) == {CORES[0]}
    assert os.sched_getaffinity(0) == os.sched_getaffinity(other_thread) == before


def test_locked_memory_is_locked_until_it_is_unlocked():
    """Memory that is taken later is locked too."""
    permitted(lock_memory=True)
    program = (
        f'{LOCKED}'
        'with scheduling_restored():\n'
        '    Scheduling(lock_memory=True).apply()\n'
        '    first = locked()\n'
        '    assert first > 1000, first\n'
        '    later = bytearray(4_000_000)\n'
        '    assert locked() > first + 3_000, (first, locked())\n'
        'assert locked() == 0, locked()\n'
    )
    subprocess.run([sys.executable, '-c', program], check=True)


@pytest.mark.parametrize('options', [{'realtime_priority': 3}, {'cpus': str(CORES[0])}])
def test_a_trial_changes_no_thread(options):
    before = os.sched_getscheduler(0), os.sched_getaffinity(0)
    with scheduling_restored():
        permitted(**options)
        assert (os.sched_getscheduler(0), os.sched_getaffinity(0)) == before


def test_a_trial_leaves_no_memory_locked():
    permitted(lock_memory=True)
    program = (
        f'{LOCKED}Scheduling(lock_memory=True).require_permitted()\nassert locked() == 0, locked()'
    )
    subprocess.run([sys.executable, '-c', program], check=True)


def test_a_user_without_permission_reads_which_option_it_is():
    """As another user, who has no permission, where this one is the superuser."""
    program = (
        'import os, resource, sys\n'
        'from ddct_plant.program.scheduling import Scheduling\n'
        'for limit in (resource.RLIMIT_RTPRIO, resource.RLIMIT_MEMLOCK):\n'
        '    resource.setrlimit(limit, (0, 0))\n'
        'if os.getuid() == 0:\n'
        '    os.setuid(65534)\n'
        'for options in ({"realtime_priority": 5}, {"lock_memory": True}):\n'
        '    for ask in (Scheduling.require_permitted, Scheduling.apply):\n'
        '        try:\n'
        '            ask(Scheduling(**options))\n'
        '        except Exception as error:\n'
        '            print(type(error).__name__, error.key)\n'
    )
    done = subprocess.run(
        [sys.executable, '-c', program], check=True, capture_output=True, text=True
    )
    assert done.stdout.split() == [
        *['ParameterError', 'realtime_priority'] * 2,
        *['ParameterError', 'lock_memory'] * 2,
    ]


@pytest.mark.parametrize('text', ['x', '0,', '-', '3-1', '0;1', '1.0', '99999999999', ' ', '0--1'])
def test_a_list_of_no_cores_is_refused(text):
    with refused(ParameterError, 'cpus'):
        Scheduling(cpus=text)


def test_a_list_of_cores_has_single_ones_and_ranges():
    assert cpus_in('0, 2-4,7') == {0, 2, 3, 4, 7}


@pytest.mark.parametrize('cpus', ['9998', f'{CORES[0]},9998'])
def test_a_core_that_is_not_there_is_refused(cpus):
    with refused(ParameterError, 'cpus'):
        Scheduling(cpus=cpus).require_permitted()


@pytest.mark.parametrize('priority', [-1, 99, 1.5])
def test_a_priority_out_of_range_is_refused(priority):
    with refused(ParameterError, 'realtime_priority'):
        Scheduling(realtime_priority=priority)


@pytest.mark.parametrize(
    'options', [{'realtime_priority': 1}, {'lock_memory': True}, {'cpus': '0'}]
)
def test_lock_step_refuses_what_is_for_real_time(options):
    (key,) = options
    with refused(ParameterError, key):
        Scheduling(**options).require_mode(lockstep=True)
    Scheduling(**options).require_mode(lockstep=False)
    Scheduling().require_mode(lockstep=True)
