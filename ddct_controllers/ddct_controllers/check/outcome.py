"""What a check comes to, and where in a controller's own code its cause is."""

import inspect
import sys
from dataclasses import dataclass

from ddct_controllers.interface import Controller

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


def place_of_error(error: BaseException, package: str) -> str:
    """Return `FILE line N` of the last step of a traceback in `package`, '' if none is there."""
    places = []
    step = error.__traceback__
    while step:
        frame = step.tb_frame
        own = str(frame.f_globals.get('__name__')).partition('.')[0] == package
        if own:
            places.append(f'{frame.f_code.co_filename} line {step.tb_lineno}')
        step = step.tb_next
    return places[-1] if places else ''


def place_of_caller(depth: int) -> str:
    """Return `FILE line N` of who called the function `depth` calls above this one."""
    frame = sys._getframe(depth + 1)
    return f'{frame.f_code.co_filename} line {frame.f_lineno}'


def place_of_method(controller: Controller, name: str) -> str:
    """Return `FILE line N` where a method of a controller begins."""
    try:
        method = inspect.unwrap(getattr(type(controller), name))
        return f'{inspect.getsourcefile(method)} line {inspect.getsourcelines(method)[1]}'
    except (OSError, TypeError):  # no source: compiled, or typed in
        return f'{type(controller).__module__}.{type(controller).__name__}.{name}'
