# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Floors on the disk, by the digest of all that they depend on."""

import dataclasses
import hashlib
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy

from ddct_bringup.floor.case import Case
from ddct_bringup.floor.dynamics.capacity import CapacityRange
from ddct_bringup.floor.dynamics.off_going import OffGoing
from ddct_bringup.floor.dynamics.start import Start
from ddct_bringup.floor.dynamics.tube import Tube
from ddct_bringup.floor.values import Floor
from ddct_bringup.manifest.code import code_digest
from ddct_bringup.manifest.manifest import file_digest
from ddct_plant.base.errors import DdctError
from ddct_plant.files.cache_folder import cache_folder
from ddct_plant.files.json_records import json_line, read_json
from ddct_plant.files.output_file import write_text
from ddct_plant.scenario.settings import is_handover_file

_KIND = 'floors'
"""Kind of the cache's folder."""


@dataclass(frozen=True)
class KnownFloor:
    """A floor, and whether runs in which limits of the engine act may do better."""

    floor: Floor
    limited: bool


@dataclass(frozen=True)
class _Content:
    """Content of a file: the values, and their own digest."""

    values: KnownFloor
    sha256: str


def digest_of(case: Case, metric: str, attain: bool) -> str:
    """Return the SHA-256 of the case, the metric, the code of all packages, and the solvers."""
    digest = hashlib.sha256(f'{code_digest()} {scipy.__version__}'.encode())
    settings = case.settings
    texts = (
        metric,
        repr(attain),
        repr(settings.scenario),
        repr(settings.known.scenario),
        repr(settings.case.wear_gain),
        repr(settings.case.off_going_wear_gain),
        _handover(settings.known.handover),
        repr(case.lock.time_s),
        repr(case.limited),
        repr(case.rules),
        repr(case.most_request),
    )
    for text in texts:
        digest.update(text.encode() + b'\0')
    for part in (case.start, case.tube, case.capacity):
        _add(digest, part)
    return digest.hexdigest()


def _handover(handover: str) -> str:
    """Return the name of a handover; for a file its SHA-256, as its content may change."""
    return file_digest(Path(handover)) if is_handover_file(handover) else handover


def _add(digest: 'hashlib._Hash', part: Start | Tube | CapacityRange | OffGoing) -> None:
    """Add the values of all fields to a digest, also those of objects within."""
    for each in dataclasses.fields(part):
        value = getattr(part, each.name)
        if isinstance(value, np.ndarray):
            digest.update(np.ascontiguousarray(value, dtype='<f8').tobytes())
        elif isinstance(value, dict):
            content = {key: [end.tolist() for end in ends] for key, ends in value.items()}
            digest.update(json.dumps(content, sort_keys=True).encode())
        elif isinstance(value, OffGoing):
            _add(digest, value)
        else:
            digest.update(repr(value).encode())


def cached(digest: str) -> KnownFloor | None:
    """
    Return the floor stored under a digest, None where there is none.

    Of a file with other values than those that were stored there is none: a floor with another
    number would be no bound.
    """
    folder = cache_folder(_KIND)
    if folder is None:
        return None
    try:
        content = read_json(_Content, folder / f'{digest}.json')
    except DdctError:
        return None
    return content.values if content.sha256 == _digest_of_values(content.values) else None


def store(digest: str, values: KnownFloor) -> None:
    """Store a floor under a digest; a folder that cannot be written is no error."""
    folder = cache_folder(_KIND)
    if folder is None:
        return
    content = json_line(_Content(values, _digest_of_values(values)))
    try:
        folder.mkdir(parents=True, exist_ok=True)
        write_text(str(folder / f'{digest}.json'), content)
    except (OSError, DdctError):
        return


def _digest_of_values(values: KnownFloor) -> str:
    """Return the SHA-256 of values, which is the same for those that JSON reads back."""
    return hashlib.sha256(json_line(values).encode()).hexdigest()
