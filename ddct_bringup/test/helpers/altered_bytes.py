# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Alter random bytes of each kind of file of a result, one at a time, and count those that are found.

    .venv/bin/python ddct_bringup/test/helpers/altered_bytes.py runs/demo --count 1000

The folder is as before afterwards.
"""

import argparse
import random
from collections.abc import Iterator
from pathlib import Path

from ddct_bringup.manifest.file_states import SAME, file_states
from ddct_bringup.manifest.manifest import MANIFEST, files_in, read_manifest
from ddct_plant.base.errors import DdctError


def kinds_of_files(folder: Path) -> dict[str, Path]:
    """Return one file of each kind in a result with content, by its name or ending."""
    files = {path.suffix or path.name: path for path in files_in(folder).values()}
    named = {path.name: path for path in files_in(folder).values() if path.suffix == '.json'}
    both = {**files, **named, MANIFEST: folder / MANIFEST}
    return {name: path for name, path in both.items() if path.stat().st_size}


def not_found(folder: Path, file: Path, count: int, seed: int = 0) -> list[int]:
    """Alter `count` random bytes of a file, one at a time; return the places not found by name."""
    original = file.read_bytes()
    draw = random.Random(seed)
    try:
        return [
            place for place in _altered(file, original, draw, count) if not _found(folder, file)
        ]
    finally:
        file.write_bytes(original)


def _altered(file: Path, original: bytes, draw: random.Random, count: int) -> Iterator[int]:
    for _ in range(count):
        place = draw.randrange(len(original))
        content = bytearray(original)
        content[place] ^= draw.randrange(1, 256)
        file.write_bytes(content)
        yield place


def _found(folder: Path, file: Path) -> bool:
    """Return whether the check names this file, and no other."""
    try:
        states = file_states(folder, read_manifest(folder))
    except DdctError as error:
        return file == folder / MANIFEST and str(error).startswith(str(file))
    wrong = [each.path for each in states if each.state != SAME]
    return wrong == [file.relative_to(folder).as_posix()]


def main() -> int:
    """Alter the bytes and print a line for each kind; return 1 where one was not found."""
    parser = argparse.ArgumentParser(description='Alter bytes of a result, and count those found.')
    parser.add_argument('folder', type=Path)
    parser.add_argument('--count', type=int, default=1000)
    options = parser.parse_args()
    missed = 0
    for name, file in kinds_of_files(options.folder).items():
        lost = len(not_found(options.folder, file, options.count))
        missed += lost
        print(f'{name}: {options.count - lost} of {options.count} altered bytes found', flush=True)
    return 1 if missed else 0


if __name__ == '__main__':
    raise SystemExit(main())
