"""What a check comes to, and where in a controller's own code its cause is."""

import sys
from dataclasses import dataclass

PASS, FAIL, SKIPPED = 'pass', 'fail', 'skipped'


@dataclass(frozen=True)
class Outcome:
    """A line of the report."""

    name: str
    state: str
    """PASS, FAIL or SKIPPED."""
    detail: str
    """What was measured; of a fail also where, and what to do."""


class CheckFailedError(Exception):
    """A check found an error; the text says what was measured, where, and what to do."""


class CheckSkippedError(Exception):
    """A check does not apply; the text says why."""


def root_cause(error: BaseException) -> BaseException:
    """Return the error that an error was first raised from."""
    while error.__cause__:
        error = error.__cause__
    return error


def place_of_caller(depth: int) -> str:
    """Return `FILE line N` of who called the function `depth` calls above this one."""
    frame = sys._getframe(depth + 1)
    return f'{frame.f_code.co_filename} line {frame.f_lineno}'
