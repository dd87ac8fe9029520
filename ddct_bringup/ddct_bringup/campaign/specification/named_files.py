# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The files that a specification names: their places, and the digest of it and of all of them."""

import hashlib
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from ddct_bringup.campaign.keys import FILE_KEY, HANDOVER
from ddct_bringup.campaign.spec import CampaignSpec
from ddct_bringup.campaign.specification.distributions import VALUES
from ddct_bringup.campaign.specification.parts import GRID, RANDOM, VARY
from ddct_controllers.from_file.digests import (
    controller_digests,
    handover_digests,
    handover_files,
)
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.choices.scenarios import CHOICES, is_packaged
from ddct_plant.scenario.nouns.composed import files_of_noun
from ddct_plant.scenario.settings import is_handover_file

_CSV = 'csv'


def placed(key: str, value: Any, place: Callable[[str], str]) -> Any:
    """Return the value of a varied key; if it names a file, with the `place` of that."""
    if type(value) in (float, int):
        return value
    if isinstance(value, str):
        is_file = key.endswith(FILE_KEY) or (key == HANDOVER and is_handover_file(value))
        return place(value) if is_file else value
    if isinstance(value, Mapping) and isinstance(value.get(_CSV), str):
        return {**value, _CSV: place(value[_CSV])}
    return value


def with_places(content: Mapping[str, Any], place: Callable[[str, str], str]) -> dict[str, Any]:
    """
    Return a valid specification with the `place` of each file that it names for its cases.

    `place` takes the key and the name of a file.
    """

    def at_place(key: str, value: Any) -> Any:
        if key in CHOICES:
            return value if is_packaged(value) else place(key, value)
        return placed(key, value, partial(place, key))

    def described_at_place(key: str, described: Mapping[str, Any]) -> Mapping[str, Any]:
        if VALUES not in described:
            return described
        return {**described, VALUES: [at_place(key, value) for value in described[VALUES]]}

    found = dict(content)
    for key in CHOICES:
        if key in found:
            found[key] = at_place(key, found[key])
    if GRID in found:
        found[GRID] = {
            key: [at_place(key, value) for value in values] for key, values in found[GRID].items()
        }
    if RANDOM in found:
        vary = found[RANDOM][VARY]
        described = {key: described_at_place(key, each) for key, each in vary.items()}
        found[RANDOM] = {**found[RANDOM], VARY: described}
    return found


def files_of(key: str, path: Path) -> list[Path]:
    """
    Return a file that a specification names by a key, then those that it is made of.

    A scenario has a car and a drive, these have bases and profiles, a handover has modules. Raise
    DdctError for one that cannot be read.
    """
    if is_handover_file(str(path)):
        return handover_files(str(path))
    return list(files_of_noun(key, str(path))) if key in CHOICES else [path]


def digest_of(spec: CampaignSpec) -> str:
    """
    Return a hash of a specification and of the files that it names.

    Nothing in these files runs. Raise DdctError for one that cannot be read.
    """
    digest = hashlib.sha256(spec.text().encode())
    for path in (*_of_choices(spec), *_of_varied_keys(spec)):
        digest.update(_content_of(path))
    for chosen in spec.chosen:
        digest.update(_digests_text(controller_digests(chosen)))
    return digest.hexdigest()


def _content_of(path: Path) -> bytes:
    """Return what stands for a file in the digest; that of a handover is not its text alone."""
    if is_handover_file(str(path)):
        return _digests_text(handover_digests(str(path)))
    try:
        return hashlib.sha256(path.read_bytes()).digest()
    except OSError as error:
        raise DdctError(f'cannot be read ({error.strerror})', place=path) from error


def _digests_text(digests: Mapping[str, str]) -> bytes:
    return repr(sorted(digests.items())).encode()


def _of_choices(spec: CampaignSpec) -> Iterator[Path]:
    """Yield the scenarios, cars and drives that are files, and the files that they are made of."""
    given = (each for choice in spec.choices for each in choice.given.items())
    for key, name in dict.fromkeys(given):
        if not is_packaged(name):
            yield from files_of_noun(key, str(spec.folder / name))


def _of_varied_keys(spec: CampaignSpec) -> Iterator[Path]:
    """Yield the files that values of varied keys name, besides scenarios."""
    found: list[str] = []

    def noted(name: str) -> str:
        found.append(name)
        return name

    for key in spec.keys:
        for value in spec.values_of(key):
            placed(key, value, noted)
    yield from (spec.folder / name for name in found)
