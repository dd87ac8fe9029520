# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A forked process ends as Python ends a main module, and without a traceback by an interrupt."""

import signal
import subprocess
import sys

import pytest

INTERRUPTED = 'raise RuntimeError from KeyboardInterrupt()'
"""What an interrupt of an import in `__set_name__` becomes."""


@pytest.mark.process
@pytest.mark.parametrize(
    ('work', 'code', 'error'),
    [
        ('return 3', 3, ''),
        ('raise SystemExit("no")', 1, 'no'),
        ('raise KeyboardInterrupt', -signal.SIGINT, ''),
        (INTERRUPTED, -signal.SIGINT, ''),
        ('raise ZeroDivisionError', 1, 'ZeroDivisionError'),
    ],
)
def test_the_exit_code_is_that_of_a_main_module(work: str, code: int, error: str) -> None:
    text = f"""\
import sys
from ddct_bringup.processes.forks import exit_code

def work():
    {work}

sys.exit(exit_code(work))
"""
    done = subprocess.run([sys.executable, '-c', text], capture_output=True, text=True)
    assert done.returncode == code
    assert [*done.stderr.splitlines()[-1:]] == ([error] if error else [])
