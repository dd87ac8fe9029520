# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Long work prints its progress; short work prints nothing."""

import io

import pytest

from ddct_plant.program.progress import Progress

HIDE_CURSOR, SHOW_CURSOR, UP, CLEAR = '\x1b[?25l', '\x1b[?25h', '\x1b[1A', '\x1b[2K'
LINES = ((30, 7), (40, 6))
"""Steps done and seconds left of the lines that are shown."""


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_the_rate_and_the_time_that_remains_are_printed_after_two_seconds() -> None:
    class Clock:
        now = 0.0

        def __call__(self) -> float:
            return self.now

    clock, stream = Clock(), io.StringIO()
    progress = Progress('runs', 10_000, done=4000, stream=stream, clock=clock)
    for clock.now, done in ((1.9, 4019), (2.5, 4025), (4.0, 4040), (13.0, 4130)):
        progress.update(done)
    assert stream.getvalue() == (
        'runs: 4025 of 10000, 10 a second, 9 min 58 s left\n'
        'runs: 4130 of 10000, 10 a second, 9 min 47 s left\n'
    )
    assert progress.line(4000) == 'runs: 4000 of 10000'
    clock.now = 7200.0
    assert progress.line(5000).endswith('10 h 0 min left')
    assert progress.line(5000, 90.0).endswith('1 min 30 s left')


def test_a_terminal_has_one_line_that_goes_in_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv('TERM', 'xterm-256color')
    times = iter([0.0, 3.0, 3.0, 3.1, 4.0, 4.0])
    stream = Terminal()
    with Progress('runs', 100, stream=stream, clock=lambda: next(times)) as progress:
        for done in (30, 31, 40):
            progress.update(done)
    first, second = (f'runs: {done} of 100, 10 a second, {left} s left' for done, left in LINES)
    shown = stream.getvalue()
    assert shown.startswith(f'{HIDE_CURSOR}{first}\r{CLEAR}{second}')
    assert shown.endswith(f'{second}\n{SHOW_CURSOR}\r{UP}{CLEAR}')


def test_work_of_unknown_length_has_a_rate_and_no_end() -> None:
    times = iter([0.0, 3.0, 3.0])
    stream = io.StringIO()
    Progress('evaluations', stream=stream, clock=lambda: next(times)).update(30)
    assert stream.getvalue() == 'evaluations: 30, 10 a second\n'
