# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Work in a process of its own returns its result, or how the process ended."""

import copyreg
import ctypes
import faulthandler
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, closing, nullcontext
from multiprocessing import connection
from pathlib import Path
from typing import Any

import pytest
from refusals import refused
from tblib.pickling_support import pickle_exception
from waiting import WITHIN_S

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.program import own_process
from ddct_plant.program.own_process import ProcessEndedError, calling, in_own_process, keep

pytestmark = pytest.mark.process
WAIT = connection.wait
FULLY_BUFFERED = 0
"""Mode of C's setvbuf in which what is printed stays in the buffer until that is full."""


def test_the_result_comes_from_another_process_without_its_changes() -> None:
    changed: list[int] = []

    def work() -> tuple[int, list[float]]:
        changed.append(1)
        return os.getpid(), [0.1, 0.2]

    process, values = in_own_process(work)
    assert (process != os.getpid(), values, changed) == (True, [0.1, 0.2], [])


def test_within_such_a_process_further_work_stays_in_it() -> None:
    assert in_own_process(lambda: in_own_process(os.getpid) == os.getpid())


def test_an_error_of_the_work_comes_back_with_key_and_place() -> None:
    def work() -> None:
        raise ParameterError('gain is nan', key='gain', place='mine.yaml: line 2')

    with refused(ParameterError, 'gain', place='mine.yaml: line 2'):
        in_own_process(work)


def test_an_error_comes_back_whole_where_a_library_pickles_causes_too(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As `distributed` does for each class of which it has sent an error."""
    monkeypatch.setitem(copyreg.dispatch_table, ParameterError, pickle_exception)

    def work() -> None:
        try:
            raise UnusualError(1, 2)
        except UnusualError as error:
            raise ParameterError('gain is nan', key='gain', place='mine.yaml: line 2') from error

    with refused(ParameterError, 'gain', place='mine.yaml: line 2') as raised:
        in_own_process(work)
    assert str(raised.value) == 'mine.yaml: line 2: gain is nan'


class UnusualError(Exception):
    """Exception that cannot be pickled, whatever a library has changed there."""

    def __init__(self, first: int, second: int) -> None:
        super().__init__(f'{first} {second}', lambda: None)

    def __str__(self) -> str:
        return str(self.args[0])


@pytest.mark.parametrize('kept', [True, False])
def test_what_cannot_be_pickled_is_one_line_with_its_type(*, kept: bool) -> None:
    def work() -> Callable[[], None]:
        if kept:
            raise UnusualError(1, 2)
        return lambda: None

    with pytest.raises(DdctError, match='UnusualError: 1 2' if kept else 'pickle'):
        in_own_process(work)


def called(name: str, step: int, end: Callable[[], object]) -> Callable[[], object]:
    def work() -> object:
        calling('reset')
        calling(name, step)
        return end()

    return work


ENDS: list[tuple[Callable[[], object], str]] = [
    (lambda: ctypes.CDLL(None).exit(0), 'it ended with exit code 0 when update was called at'),
    (lambda: os._exit(3), 'it ended with exit code 3 when update was called at step 7'),
    (os.abort, 'it crashed (SIGABRT) when update was called at step 7'),
    (lambda: ctypes.string_at(0), 'it crashed (SIGSEGV) when update was called at step 7'),
    (lambda: os.kill(os.getpid(), signal.SIGKILL), 'it crashed (SIGKILL) when update was'),
]


@pytest.mark.parametrize(('end', 'reason'), ENDS)
def test_the_reason_has_how_it_ended_and_in_which_call(
    end: Callable[[], object], reason: str
) -> None:
    with refused(ProcessEndedError) as raised:
        in_own_process(called('update', 7, end))
    assert str(raised.value).startswith(reason)


def test_the_reason_says_when_no_step_or_no_call_was_reached() -> None:
    with pytest.raises(ProcessEndedError, match=r'^it crashed \(SIGABRT\) when it was loaded$'):
        in_own_process(lambda: ctypes.CDLL(None).abort())
    with pytest.raises(ProcessEndedError, match=r'^it crashed .* when reset was called$'):
        in_own_process(called('reset', -1, os.abort))


def test_the_reason_has_step_0_too() -> None:
    with pytest.raises(ProcessEndedError, match='when update was called at step 0$'):
        in_own_process(called('update', 0, os.abort))


def test_exit_in_c_prints_and_leaves_out_what_libraries_do_at_the_end() -> None:
    program = (
        'import ctypes, os; from ddct_plant.program.own_process import in_own_process\n'
        'libc = ctypes.CDLL(None)\n'
        'libc.__cxa_atexit(libc.abort, None, None)\n'
        'try:\n'
        "    in_own_process(lambda: (libc.puts(b'printed'), libc.exit(3)))\n"
        'except Exception as error:\n'
        '    os.write(2, str(error).encode())\n'
        'os._exit(0)\n'
    )
    done = subprocess.run([sys.executable, '-c', program], capture_output=True, timeout=WITHIN_S)
    assert done.stderr == b'printed\nit ended with exit code 3 when it was loaded'


class Turns:
    """The caller and the work take turns, in place of the time between two looks at the work."""

    def __init__(self, number: int, then_s: float | None) -> None:
        """Take a number of turns; then a look waits `then_s` for the end, or until it comes."""
        self._left, self._then_s = number, then_s
        self._given, self._taken = os.pipe(), os.pipe()

    def wait(self, waited: Sequence[Any], _: float) -> Sequence[object]:
        """Let the work take a turn and find that it goes on; afterwards look whether it does."""
        if not self._left:
            return WAIT(waited, self._then_s)
        self._left -= 1
        os.write(self._given[1], b' ')
        os.read(self._taken[0], 1)
        return []

    def take(self, turn: Callable[[], object]) -> None:
        """Take a turn, in the work."""
        os.read(self._given[0], 1)
        turn()
        os.write(self._taken[1], b' ')

    def close(self) -> None:
        """Close the pipes."""
        for descriptor in (*self._given, *self._taken):
            os.close(descriptor)


@pytest.fixture
def turns_of(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Turns]]:
    """Return a function that makes the turns of the caller and the next work."""
    with ExitStack() as made:

        def make(number: int, *, then_s: float | None) -> Turns:
            turns = made.enter_context(closing(Turns(number, then_s)))
            monkeypatch.setattr(connection, 'wait', turns.wait)
            return turns

        yield make


def test_work_that_makes_no_call_for_long_is_ended_with_the_last_call(
    turns_of: Callable[..., Turns],
) -> None:
    turns = turns_of(1, then_s=0.0)

    def work() -> None:
        turns.take(lambda: calling('update', 7))
        time.sleep(600)

    words = '^it gave no answer within 10 s when update was called at step 7'
    with pytest.raises(ProcessEndedError, match=words):
        in_own_process(work)


def test_work_that_goes_on_calling_may_take_longer_than_the_limit(
    turns_of: Callable[..., Turns],
) -> None:
    number = round(2.0 * own_process._MOST_SECONDS / own_process._POLL_S)
    turns = turns_of(number, then_s=None)

    def work() -> int:
        for _ in range(number):
            turns.take(lambda: calling('reset'))
        return 5

    assert in_own_process(work) == 5


def test_a_crash_after_the_result_does_not_lose_it() -> None:
    def work() -> int:
        keep(object(), os.abort)
        return 5

    assert in_own_process(work) == 5


@pytest.mark.parametrize('fails', [False, True])
def test_what_was_kept_is_ended_also_after_an_error(tmp_path: Path, *, fails: bool) -> None:
    ended = tmp_path / 'ended'

    def work() -> bool:
        keep(object(), ended.touch)
        if fails:
            raise DdctError('it has failed')
        return ended.exists()

    with pytest.raises(DdctError) if fails else nullcontext():
        assert not in_own_process(work)
    assert ended.exists()


def test_nothing_is_kept_outside_of_such_a_process() -> None:
    keep(object(), os.abort)
    calling('update', 1)
    assert (own_process._kept, own_process._note) == ([], None)


def test_what_it_prints_goes_to_standard_error(capfd: pytest.CaptureFixture[str]) -> None:
    in_own_process(lambda: ctypes.CDLL(None).puts(b'hello') and 0)
    printed = capfd.readouterr()
    assert (printed.out, printed.err) == ('', 'hello\n')


def test_what_it_prints_before_it_ends_itself_is_not_lost(
    capfd: pytest.CaptureFixture[str],
) -> None:
    libc, buffer = ctypes.CDLL(None), ctypes.create_string_buffer(4096)

    def work() -> None:
        # Python has switched the buffer off where PYTHONUNBUFFERED is set.
        libc.setvbuf(ctypes.c_void_p.in_dll(libc, 'stdout'), buffer, FULLY_BUFFERED, 4096)
        libc.printf(b'out of oil')
        libc.exit(0)

    with pytest.raises(ProcessEndedError):
        in_own_process(work)
    assert capfd.readouterr().err == 'out of oil'


def test_what_c_printed_before_is_not_printed_again(capfd: pytest.CaptureFixture[str]) -> None:
    libc = ctypes.CDLL(None)
    libc.puts(b'before')
    in_own_process(lambda: None)
    libc.fflush(None)
    assert capfd.readouterr() == ('before\n', '')


def test_a_crash_in_it_writes_no_stacks() -> None:
    assert faulthandler.is_enabled(), 'this test shows nothing'
    assert not in_own_process(faulthandler.is_enabled)


def test_it_reads_no_input_and_ignores_ctrl_c() -> None:
    def work() -> bytes:
        os.kill(os.getpid(), signal.SIGINT)
        return os.read(0, 1)

    assert in_own_process(work) == b''


def test_an_interruption_of_the_caller_ends_it(monkeypatch: pytest.MonkeyPatch) -> None:
    forked: list[int] = []
    fork = os.fork

    def noted() -> int:
        forked.append(fork())
        return forked[-1]

    def interrupted(*_: object) -> None:
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(os, 'fork', noted)
    monkeypatch.setattr(connection, 'wait', interrupted)
    with pytest.raises(KeyboardInterrupt):
        in_own_process(lambda: time.sleep(2 * WITHIN_S))
    assert not Path(f'/proc/{forked[0]}').exists()


def test_it_ends_with_a_caller_that_is_killed() -> None:
    program = (
        'import os, time; from ddct_plant.program.own_process import in_own_process\n'
        'in_own_process(lambda: (os.kill(os.getppid(), 9), time.sleep(600)))\n'
    )
    # The pipe of standard error ends with the last process that has it.
    done = subprocess.run(
        [sys.executable, '-c', program], stderr=subprocess.PIPE, check=False, timeout=WITHIN_S
    )
    assert done.returncode == -signal.SIGKILL
