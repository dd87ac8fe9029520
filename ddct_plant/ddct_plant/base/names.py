"""What a scenario, a controller or a bag may be called: a name becomes the name of a file."""

import re

from ddct_plant.base.errors import ParameterError

MOST_CHARACTERS = 64
"""File names are made of two names and an ending, and a file system takes 255 bytes."""
_NAME = re.compile(rf'[A-Za-z0-9_][A-Za-z0-9._-]{{0,{MOST_CHARACTERS - 1}}}')


def require_name(what: str, name: object) -> None:
    """Raise ParameterError unless `name` of `what` is a plain name, so never part of a path."""
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        raise ParameterError(
            f'{what} is {name!r}: use up to {MOST_CHARACTERS} letters (A to Z, a to z), digits, '
            'dots, dashes and underscores, no dot or dash first'
        )
