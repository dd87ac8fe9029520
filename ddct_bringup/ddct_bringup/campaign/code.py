"""Which sources compute a campaign: results of two versions are never mixed."""

import hashlib
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable

from ddct_plant.base.errors import DdctError

_PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
_SOURCES = ('.py', '.yaml')


@cache
def code_digest() -> str:
    """Return a hash of the sources of our packages as they are now: a commit may be dirty."""
    digest = hashlib.sha256()
    for package in _PACKAGES:
        _add(digest, package, files(package))
    return digest.hexdigest()


def require_code(digest: str) -> None:
    """Raise DdctError unless this process has the sources that a campaign began with."""
    if code_digest() != digest:
        raise DdctError(
            'a worker has other sources than the program that started the campaign: install the '
            'same version there'
        )


def _add(digest: 'hashlib._Hash', name: str, item: Traversable) -> None:
    if item.is_dir():
        for each in sorted(item.iterdir(), key=lambda each: each.name):
            _add(digest, f'{name}/{each.name}', each)
    elif name.endswith(_SOURCES):
        digest.update(name.encode())
        digest.update(item.read_bytes())
