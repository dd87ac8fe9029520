# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""However many signals a program gets, it ends with one line and the exit code of the first."""

import os
import signal
import subprocess
import sys
import threading
from contextlib import contextmanager

import pytest

from ddct_plant.program import command_line, signals
from ddct_plant.program.command_line import run_program

_OURS = {command_line.__file__, signals.__file__}


class _SecondSignal:
    """Trace function that sends SIGINT at the n-th event in the frames of `run_program`."""

    def __init__(self, number):
        """Count from the end of the work, when `start` is called."""
        self._left = number

    def start(self, frame):
        """Trace this frame, those that it returns to, and all new ones."""
        while frame is not None:
            frame.f_trace = self._event
            frame = frame.f_back
        sys.settrace(self._event)

    @property
    def sent(self):
        """Whether there were so many events."""
        return self._left <= 0

    def _event(self, frame, *_):
        if frame.f_code.co_filename in _OURS:
            self._left -= 1
            if not self._left:
                signal.raise_signal(signal.SIGINT)
        return self._event


def interrupted_work(second):
    def work(_argv):
        second.start(sys._getframe())
        signal.raise_signal(signal.SIGINT)

    return work


def nested(work):
    return lambda argv: run_program('x sweep', work, argv)


@pytest.fixture
def handler():
    """Yield a handler of SIGINT that the program finds, and restores at its end."""

    def ignore(*_):
        pass

    before = signal.signal(signal.SIGINT, ignore)
    yield ignore
    signal.signal(signal.SIGINT, before)


def result_with(second, within):
    """Return the exit code of a program that gets a second signal, or the exception it raises."""
    traced = sys.gettrace()
    try:
        return run_program('x', within(interrupted_work(second)), [])
    except KeyboardInterrupt as error:
        return error
    finally:
        sys.settrace(traced)


@pytest.mark.parametrize(('within', 'name'), [(lambda work: work, 'x'), (nested, 'x sweep')])
def test_a_second_signal_at_any_moment_changes_nothing(within, name, handler, capfd):
    """It comes at the first event after the work, in another run at the next one, and so on."""
    number, ended = 0, False
    while not ended:
        number += 1
        second = _SecondSignal(number)
        code = result_with(second, within)
        ended = not second.sent
        assert (code, capfd.readouterr().err) == (130, f'{name}: interrupted\n'), number
    assert number > 20
    assert signal.getsignal(signal.SIGINT) == handler


def test_a_signal_before_the_work_keeps_it_from_beginning(capsys, monkeypatch):
    @contextmanager
    def after_a_signal(ends_process):
        signal.raise_signal(signal.SIGINT)
        yield

    monkeypatch.setattr(command_line, '_rare_collection', after_a_signal)
    done: list[list[str]] = []
    assert run_program('x', done.append, []) == 130
    assert (done, capsys.readouterr().err) == ([], 'x: interrupted\n')


def test_a_program_in_another_thread_leaves_signals_alone():
    codes = []
    thread = threading.Thread(target=lambda: codes.append(run_program('x', lambda _: 3, [])))
    thread.start()
    thread.join()
    assert codes == [3]


@pytest.mark.process
@pytest.mark.parametrize(
    'end',
    [
        'os.kill(os.getpid(), signal.SIGINT); print("not reached")',
        'atexit.register(signal.raise_signal, signal.SIGINT)',
        'late = Late()',
    ],
    ids=['after the program', 'at exit', 'while modules are freed'],
)
def test_a_further_ctrl_c_at_the_end_of_the_process_gives_no_traceback(end):
    program = (
        'import atexit, os, signal, sys\n'
        'from ddct_plant.program.command_line import run_program\n'
        'class Late:\n'
        '    def __del__(self, kill=os.kill, ours=os.getpid(), number=int(signal.SIGINT)):\n'
        '        kill(ours, number)\n'
        "code = run_program('x', lambda _: os.kill(os.getpid(), signal.SIGINT), None)\n"
        f'{end}\n'
        'sys.exit(code)'
    )
    done = subprocess.run(
        [sys.executable, '-c', program],
        env={**os.environ, 'PYTHONPATH': os.pathsep.join(filter(None, sys.path))},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, '', 'x: interrupted\n')
