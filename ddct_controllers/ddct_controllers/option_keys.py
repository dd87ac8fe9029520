"""Keys of a controller's section `controllers.<name>` of a scenario."""

from collections.abc import Iterable

from ddct_plant.base.errors import ParameterError


def require_known_keys(name: str, given: Iterable[object], known: Iterable[str]) -> None:
    """Raise ParameterError that names a key which the controller `name` does not have."""
    known = tuple(known)
    unknown = set(given) - set(known)
    if unknown:
        raise ParameterError(
            f'controllers.{name}.{min(unknown, key=str)} is not a key of {name}: it has '
            f'{", ".join(known)}'
        )
