# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Exit codes of programs, and the one-line error message for a user's mistake."""

import gc
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from samples import sampled
from waiting import WITHIN_S

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.program.command_line import ProgramParser, run_program
from ddct_plant.program.signals import stop_signals


def raising(error):
    def main_function(_argv):
        raise error

    return main_function


def test_the_exit_code_of_the_work_is_the_programs():
    assert run_program('x', lambda argv: len(argv), ['a', 'b']) == 2


def test_arguments_come_from_the_command_line_by_default(monkeypatch):
    monkeypatch.setattr(sys, 'argv', ['x', 'a'])
    assert run_program('x', lambda argv: 0 if argv == ['a'] else 1, None) == 0


@pytest.mark.parametrize('kind', [DdctError, ParameterError])
def test_a_mistake_is_one_line_with_the_programs_name(kind, capsys):
    assert run_program('x', raising(kind('gain is -1: it must be above 0')), []) == 1
    captured = capsys.readouterr()
    assert (captured.out, captured.err) == ('', 'x: gain is -1: it must be above 0\n')


def test_an_interrupt_gives_130(capsys):
    assert run_program('x', raising(KeyboardInterrupt()), []) == 130
    assert capsys.readouterr().err == 'x: interrupted\n'


def raising_from_interrupt(error):
    def main_function(_argv):
        raise error from KeyboardInterrupt()

    return main_function


@pytest.mark.parametrize('error', [DdctError('no'), OSError('no'), RuntimeError('no')])
def test_an_error_that_an_interrupt_became_gives_130_too(error, capsys):
    assert run_program('x', raising_from_interrupt(error), []) == 130
    assert capsys.readouterr().err == 'x: interrupted\n'


def test_an_error_on_the_way_out_of_an_interrupt_is_reported(capsys):
    def main_function(_argv):
        try:
            raise KeyboardInterrupt
        finally:
            raise DdctError('the disk is full')

    assert run_program('x', main_function, []) == 1
    assert capsys.readouterr().err == 'x: the disk is full\n'


def test_a_fault_after_a_signal_keeps_its_traceback():
    def main_function(_argv):
        with stop_signals():
            os.kill(os.getpid(), signal.SIGINT)
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        run_program('x', main_function, [])


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_signal_outside_of_a_run_is_one_line_and_its_exit_code(number, capsys):
    before = signal.getsignal(number)
    assert run_program('x', lambda _: os.kill(os.getpid(), number), []) == 128 + number
    assert capsys.readouterr().err == 'x: interrupted\n'
    assert signal.getsignal(number) == before


def test_a_fault_of_the_program_keeps_its_traceback():
    with pytest.raises(ZeroDivisionError):
        run_program('x', raising(ZeroDivisionError()), [])


REFUSED = {
    "print('x' * 100_000)": 'the output: No space left on device',
    "print('x')": 'the output: No space left on device',
    "ProgramParser(prog='x').parse_args(['--help'])": 'the output: No space left on device',
    "print('x'); raise DdctError('too much')": 'No space left on device',
    "Path('a' * 300).exists()": f'{"a" * 300}: File name too long: give a shorter name',
    "Path('/proc/x').write_text('')": '/proc/x: No such file or directory',
}
"""Works of a program whose standard output is a full disk, and the end of what it says."""


@pytest.mark.process
@pytest.mark.parametrize('unbuffered', sampled(['', '1'], every=2))
def test_what_the_system_refuses_is_one_line_without_a_traceback(unbuffered):
    program = (
        'import os, sys\n'
        'from pathlib import Path\n'
        'from ddct_plant.program.command_line import ProgramParser, run_program\n'
        'from ddct_plant.base.errors import DdctError\n'
        'for work in sys.argv[1:]:\n'
        '    if child := os.fork():\n'
        '        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 1, work\n'
        '    else:\n'
        "        sys.exit(run_program('x', lambda _: exec(work), []))\n"
    )
    environment = {**os.environ, 'PYTHONPATH': os.pathsep.join(filter(None, sys.path))}
    with Path('/dev/full').open('w') as full:
        done = subprocess.run(
            [sys.executable, '-c', program, *REFUSED],
            env={**environment, 'PYTHONUNBUFFERED': unbuffered},
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 0, done.stderr
    for line, expected in zip(done.stderr.splitlines(), REFUSED.values(), strict=True):
        assert line.startswith('x: ')
        assert expected in line


def test_without_a_standard_output_the_work_is_done(monkeypatch):
    monkeypatch.setattr(sys, 'stdout', None)
    assert run_program('x', lambda argv: 0, []) == 0


def test_control_characters_on_the_command_line_do_not_reach_the_terminal(capsys):
    with pytest.raises(SystemExit):
        ProgramParser(prog='x').parse_args(['--\x1b[31m'])
    assert capsys.readouterr().err == 'x: unrecognized arguments: --\\x1b[31m: see x --help\n'


@pytest.mark.process
@pytest.mark.parametrize('size', [1, 100_000], ids=['kept in the buffer', 'written at once'])
def test_a_reader_that_has_gone_ends_the_program_quietly(size):
    program = (
        'import sys; from ddct_plant.program.command_line import run_program\n'
        f"def work(_): sys.stdin.readline(); print('x' * {size}); return 0\n"
        "sys.exit(run_program('x', work, []))"
    )
    with subprocess.Popen(
        [sys.executable, '-c', program],
        env={**os.environ, 'PYTHONPATH': os.pathsep.join(filter(None, sys.path))},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        process.stdout.close()
        process.stdin.write('go\n')
        process.stdin.close()
        assert process.wait(timeout=WITHIN_S) == 141
        assert process.stderr.read() == ''


@pytest.fixture
def usual_threshold():
    """Set and return Python's thresholds of garbage collection; the suite has others."""
    suite, usual = gc.get_threshold(), (700, 10, 10)
    gc.set_threshold(*usual)
    yield usual
    gc.set_threshold(*suite)


@pytest.mark.parametrize('fails', [False, True])
def test_a_program_searches_for_garbage_less_often_and_leaves_that_as_before(
    fails, usual_threshold
):
    def main_function(argv):
        assert gc.get_threshold()[0] > usual_threshold[0]
        if fails:
            raise DdctError('it fails')
        return 0

    assert run_program('name', main_function, []) == int(fails)
    assert gc.get_threshold() == usual_threshold
