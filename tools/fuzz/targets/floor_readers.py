# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The reader of the cache of floors: a damaged file counts as none, never as another number."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ddct_bringup.floor.cache import KnownFloor, cached, store
from ddct_bringup.floor.values import Floor, Proof
from ddct_plant.base.errors import DdctError
from ddct_plant.files.cache_folder import cache_folder
from fuzz.reader import Reader

_NAME, _VARIABLE = 'floor', 'DDCT_CACHE'
_VALUES = KnownFloor(
    Floor('peak_jerk', 0.71, 1.25, None, Proof('bound', 1.25, 'runs'), None), limited=False
)


def floor_reader(folder: Path) -> Reader:
    """Return the reader; a good file is made in a folder."""
    with _cache(folder) as place:
        store(_NAME, _VALUES)
        good = (place / f'{_NAME}.json').read_bytes()
    return Reader('floor', 'kept.json', _kept, (good,), exact=True)


def _kept(file: Path) -> object:
    with _cache(file.parent) as place:
        place.mkdir(parents=True, exist_ok=True)
        (place / f'{_NAME}.json').write_bytes(file.read_bytes())
        found = cached(_NAME)
    if found is None:
        raise DdctError('there are no values, and the floor is computed')
    return found


@contextmanager
def _cache(folder: Path) -> Iterator[Path]:
    """Use a cache in a folder for a while, and yield the folder of its files."""
    before = os.environ.get(_VARIABLE)
    os.environ[_VARIABLE] = str(folder)
    try:
        place = cache_folder('floors')
        assert place is not None
        yield place
    finally:
        os.environ.pop(_VARIABLE)
        if before is not None:
            os.environ[_VARIABLE] = before
