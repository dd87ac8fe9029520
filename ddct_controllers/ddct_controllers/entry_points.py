"""Load what other packages add through entry points, with one clear error when that fails."""

import importlib.metadata
from typing import Any

from ddct_plant.errors import DdctError


def load_entry_point(point: importlib.metadata.EntryPoint, what: str) -> Any:
    """Return the object that `point` names; raise DdctError that calls it `what` otherwise."""
    try:
        return point.load()
    except Exception as error:
        raise DdctError(
            f'{what} {point.name!r}: the entry point {point.value} cannot be loaded '
            f'({type(error).__name__}: {error}): mend or uninstall the package that adds it'
        ) from error
