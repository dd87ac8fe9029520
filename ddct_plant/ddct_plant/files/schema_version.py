"""The version of a file's keys, so that an older program says why it cannot read a newer file."""

from collections.abc import Mapping
from typing import Any

from ddct_plant.base.errors import ParameterError

KEY = 'schema_version'


def require_schema_version(content: Mapping[str, Any], newest: int) -> None:
    """Raise ParameterError unless the version, `newest` if not given, can be read."""
    version = content.get(KEY, newest)
    if isinstance(version, bool) or not isinstance(version, int) or version < 1:
        raise ParameterError(f'{KEY} is {version!r}: give a whole number from 1 to {newest}')
    if version > newest:
        raise ParameterError(
            f'{KEY} is {version}, this version reads up to {newest}: update the project'
        )
