# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Long work prints its progress; short work prints nothing."""

import io
import sys

import pytest

from ddct_plant.program import progress as module
from ddct_plant.program.progress import Progress

HIDE_CURSOR, SHOW_CURSOR, UP, CLEAR = '\x1b[?25l', '\x1b[?25h', '\x1b[1A', '\x1b[2K'
LINES = ((30, 7), (40, 6))
"""Steps done and seconds left of the lines that are shown."""


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


class Clock:
    now = 0.0

    def perf_counter(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    """Return the clock that progress reads, in s, which stands until it is set."""
    found = Clock()
    monkeypatch.setattr(module, 'time', found)
    return found


@pytest.mark.parametrize(
    ('at_s', 'done', 'left_s', 'line'),
    [
        (2.5, 4025, None, '4025 of 10000, 10 a second, 9 min 58 s left'),
        (2.5, 4000, None, '4000 of 10000'),
        (7200.0, 5000, None, '5000 of 10000, 0.139 a second, 10 h 0 min left'),
        (7200.0, 5000, 90.0, '5000 of 10000, 0.139 a second, 1 min 30 s left'),
    ],
)
def test_a_line_has_the_rate_and_the_time_that_remains(
    clock: Clock,
    capsys: pytest.CaptureFixture[str],
    at_s: float,
    done: int,
    left_s: float | None,
    line: str,
) -> None:
    progress = Progress('runs', 10_000, done=4000)
    clock.now = at_s
    progress.update(done, left_s)
    assert capsys.readouterr().err == f'runs: {line}\n'


def test_a_line_is_printed_after_two_seconds_and_then_every_ten(
    clock: Clock, capsys: pytest.CaptureFixture[str]
) -> None:
    progress = Progress('runs', 10_000, done=4000)
    for clock.now, done in ((1.9, 4019), (2.5, 4025), (4.0, 4040), (13.0, 4130)):
        progress.update(done)
    assert capsys.readouterr().err == (
        'runs: 4025 of 10000, 10 a second, 9 min 58 s left\n'
        'runs: 4130 of 10000, 10 a second, 9 min 47 s left\n'
    )


def test_a_terminal_has_one_line_that_goes_in_the_end(
    clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv('TERM', 'xterm-256color')
    stream = Terminal()
    monkeypatch.setattr(sys, 'stderr', stream)
    with Progress('runs', 100) as progress:
        for clock.now, done in ((3.0, 30), (3.1, 31), (4.0, 40)):
            progress.update(done)
    first, second = (f'runs: {done} of 100, 10 a second, {left} s left' for done, left in LINES)
    shown = stream.getvalue()
    assert shown.startswith(f'{HIDE_CURSOR}{first}\r{CLEAR}{second}')
    assert shown.endswith(f'{second}\n{SHOW_CURSOR}\r{UP}{CLEAR}')


def test_work_of_unknown_length_has_a_rate_and_no_end(
    clock: Clock, capsys: pytest.CaptureFixture[str]
) -> None:
    progress = Progress('evaluations')
    clock.now = 3.0
    progress.update(30)
    assert capsys.readouterr().err == 'evaluations: 30, 10 a second\n'
