# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Digest of the sources of the packages."""

import hashlib
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from importlib.util import find_spec
from pathlib import Path

_PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
_SOURCES = ('.py', '.yaml')


@cache
def code_digest() -> str:
    """Return a hash of the current sources of the packages: a commit may be dirty."""
    digest = hashlib.sha256()
    for package in _PACKAGES:
        _add(digest, package, files(package))
    return digest.hexdigest()


@cache
def package_digest(name: str) -> str:
    """Return a hash of the sources of an installed package, or of a module without a package."""
    digest = hashlib.sha256()
    spec = find_spec(name)
    if spec is not None and spec.submodule_search_locations:
        _add(digest, name, files(name))
    elif spec is not None and spec.origin:
        digest.update(Path(spec.origin).read_bytes())
    return digest.hexdigest()


def _add(digest: 'hashlib._Hash', name: str, item: Traversable) -> None:
    if item.is_dir():
        for each in sorted(item.iterdir(), key=lambda each: each.name):
            _add(digest, f'{name}/{each.name}', each)
    elif name.endswith(_SOURCES):
        digest.update(name.encode())
        digest.update(item.read_bytes())
