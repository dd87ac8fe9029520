# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Place of an error's cause for the author of a controller: in code or files of their own."""

import inspect
import traceback
from pathlib import Path

from ddct_controllers.interface import Controller
from ddct_plant.files.input_file import without_folder


def place_of_error(error: BaseException, package: str) -> str:
    """
    Return `FILE line N` of the last step of a traceback in `package`, '' if none is there.

    Of an error of syntax in a file it is the place of that.
    """
    if isinstance(error, SyntaxError) and Path(error.filename or '').is_file():
        return f'{error.filename} line {error.lineno}'
    places = [
        f'{frame.f_code.co_filename} line {line}'
        for frame, line in traceback.walk_tb(error.__traceback__)
        if str(frame.f_globals.get('__name__')).partition('.')[0] == package
    ]
    return places[-1] if places else ''


def place_of_method(controller: Controller, name: str) -> str:
    """
    Return `FILE line N` where a method of a controller begins.

    For one that is not in Python: its source, such as a key of a YAML file, and the method's name
    there.
    """
    own_name = controller.method_names.get(name)
    if place := controller.written_in:
        return f'{own_name} of {place}' if own_name else place
    try:
        method = inspect.unwrap(getattr(controller, own_name or name))
        return f'{inspect.getsourcefile(method)} line {inspect.getsourcelines(method)[1]}'
    except (OSError, TypeError):  # no source: compiled, or typed in
        return f'{type(controller).__module__}.{type(controller).__name__}.{name}'


def place_of_failure(controller: Controller, error: BaseException) -> str:
    """
    Return the place at which an update raised `error`, in its author's code.

    The file is without its folder: the reason of a failed run is the same wherever it runs.
    """
    package = type(controller).__module__.partition('.')[0]
    line = '' if controller.written_in else place_of_error(error, package)
    place = without_folder(line or controller.written_in or place_of_method(controller, 'update'))
    own_name = controller.method_names.get('update') if controller.written_in else None
    return f'{own_name} of {place}' if own_name else place
