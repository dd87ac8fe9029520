"""Where in a controller's own code the cause of an error is."""

import inspect

from ddct_controllers.interface import Controller


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


def place_of_method(controller: Controller, name: str) -> str:
    """Return `FILE line N` where a method of a controller begins."""
    try:
        method = inspect.unwrap(getattr(controller, name))
        return f'{inspect.getsourcefile(method)} line {inspect.getsourcelines(method)[1]}'
    except (OSError, TypeError):  # no source: compiled, or typed in
        return f'{type(controller).__module__}.{type(controller).__name__}.{name}'
