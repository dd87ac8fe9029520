"""Where in a controller's own code the cause of an error is."""

import inspect
import traceback

from ddct_controllers.interface import Controller


def place_of_error(error: BaseException, package: str) -> str:
    """Return `FILE line N` of the last step of a traceback in `package`, '' if none is there."""
    places = [
        f'{frame.f_code.co_filename} line {line}'
        for frame, line in traceback.walk_tb(error.__traceback__)
        if str(frame.f_globals.get('__name__')).partition('.')[0] == package
    ]
    return places[-1] if places else ''


def place_of_method(controller: Controller, name: str) -> str:
    """Return `FILE line N` where a method of a controller begins."""
    try:
        method = inspect.unwrap(getattr(controller, name))
        return f'{inspect.getsourcefile(method)} line {inspect.getsourcelines(method)[1]}'
    except (OSError, TypeError):  # no source: compiled, or typed in
        return f'{type(controller).__module__}.{type(controller).__name__}.{name}'
