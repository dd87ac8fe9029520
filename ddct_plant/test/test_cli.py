"""How programs end: exit codes, and one line for a user's mistake."""

import os
import subprocess
import sys

import pytest

from ddct_plant.cli import run_program
from ddct_plant.errors import DdctError, ParameterError


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


def test_a_fault_of_the_program_keeps_its_traceback():
    with pytest.raises(ZeroDivisionError):
        run_program('x', raising(ZeroDivisionError()), [])


def test_a_reader_that_has_gone_ends_the_program_quietly():
    program = (
        'import sys; from ddct_plant.cli import run_program\n'
        "def work(_): sys.stdin.readline(); print('x' * 100_000); return 0\n"
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
        assert process.wait(timeout=30.0) == 141
        assert process.stderr.read() == ''
