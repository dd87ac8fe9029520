# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Draw mutations by room, in proportion to its lines of code."""

import random
from collections.abc import Callable, Collection, Sequence
from pathlib import Path

from mutation.operators import Mutation, code_lines, mutations

PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')


def room_of(file: str) -> str:
    """Return the room of a product file: its package and the first folder in it."""
    parts = Path(file).parts
    return '/'.join(parts[1:3]) if len(parts) > 3 else parts[1]


def product_files(root: Path) -> list[str]:
    """Return the Python files of the product, sorted."""
    return sorted(
        file.relative_to(root).as_posix()
        for package in PACKAGES
        for file in (root / package / package).rglob('*.py')
        if '/template/files/' not in file.as_posix()
    )


def draw(
    root: Path,
    count: int,
    seed: int,
    files: Collection[str] | None = None,
    wanted: Callable[[Mutation], bool] = lambda mutation: True,
) -> list[Mutation]:
    """
    Return `count` mutations of the product, or of `files` of it, that are `wanted`.

    A room gets its share of the lines of code (largest remainders); within it each mutation is
    equally likely, and no line is drawn twice. What a room lacks is drawn from all others.
    """
    chance = random.Random(seed)
    rooms: dict[str, list[str]] = {}
    for file in product_files(root):
        if files is None or file in files:
            rooms.setdefault(room_of(file), []).append(file)
    sizes = {
        room: sum(code_lines((root / file).read_text(encoding='utf-8')) for file in members)
        for room, members in rooms.items()
    }
    drawn: list[Mutation] = []
    rest: list[Mutation] = []
    for room, share in _shares(sizes, count).items():
        found = [each for file in rooms[room] for each in mutations(root, file) if wanted(each)]
        rest += _take(found, share, drawn, chance)
    _take(rest, count - len(drawn), drawn, chance)
    return drawn


def _take(
    found: list[Mutation], share: int, drawn: list[Mutation], chance: random.Random
) -> list[Mutation]:
    """Move up to `share` of the mutations found into `drawn`, and return the others."""
    chance.shuffle(found)
    lines = {(each.file, each.line) for each in drawn}
    others = []
    for each in found:
        if share > 0 and (each.file, each.line) not in lines:
            lines.add((each.file, each.line))
            drawn.append(each)
            share -= 1
        else:
            others.append(each)
    return others


def _shares(sizes: dict[str, int], count: int) -> dict[str, int]:
    """Divide a count in proportion to sizes, by largest remainders."""
    total = sum(sizes.values())
    exact = {room: count * size / total for room, size in sizes.items()}
    shares = {room: int(value) for room, value in exact.items()}
    rest = sorted(exact, key=lambda room: shares[room] - exact[room])
    for room in rest[: count - sum(shares.values())]:
        shares[room] += 1
    return shares


def find_again(root: Path, earlier: Sequence[Mutation]) -> list[Mutation | None]:
    """Return where each mutation of an earlier commit is in this one; None if it is gone."""
    known: dict[tuple[object, ...], Mutation] = {}
    for file in {each.file for each in earlier if (root / each.file).exists()}:
        for each in mutations(root, file):
            known[(*each.key(), each.ordinal)] = each
    return [known.get((*each.key(), each.ordinal)) for each in earlier]
