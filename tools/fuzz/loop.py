# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Give a reader random edits of its known inputs for some seconds, and keep what it fails on.

Its known inputs are the good ones, which are made anew, those of findings, which are in git, and
those by which the guided runs have reached new code. The latter stay in a folder that git ignores:
there are hundreds for each reader, and a change of a format makes them worthless, while the good
ones follow it.
"""

import hashlib
import random
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from fuzz.edits import edited, random_edits
from fuzz.reader import Reader

_ROOT = Path(__file__).resolve().parents[2]
FOUND = _ROOT / 'tests' / 'formats' / 'found_inputs'
"""Folder with the inputs of findings, by reader."""
REACHED = _ROOT / '.fuzz_cache'
"""Folder with the inputs by which guided runs have reached new code, by reader; git ignores it."""
LONGEST_S = 20.0
"""Longest time for one input, s; more is a hang."""


class HangError(Exception):
    """An input takes too long."""


@contextmanager
def bounded_time() -> Iterator[None]:
    """Raise HangError after `LONGEST_S`."""

    def hang(*_: object) -> None:
        raise HangError(f'more than {LONGEST_S:g} s')

    before = signal.signal(signal.SIGALRM, hang)
    signal.setitimer(signal.ITIMER_REAL, LONGEST_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def fuzz(reader: Reader, seconds: float, seed: int, folder: Path, kept: Path) -> tuple[int, int]:
    """Return the numbers of inputs and of findings; write the inputs of findings into `kept`."""
    source = random.Random(f'{reader.name} {seed}')
    known = (*reader.seeds, *inputs_in(kept), *inputs_in(REACHED / reader.name))
    inputs, found = 0, set()
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        data = edited(source.choice(known), random_edits(source))
        with bounded_time():
            what = reader.finding(data, folder)
        inputs += 1
        kind = what[:60]
        if what and kind not in found:
            found.add(kind)
            print(f'{reader.name}: {what[:300]}', flush=True)
            keep(data, kept)
    return inputs, len(found)


def inputs_in(folder: Path) -> list[bytes]:
    """Return the inputs in a folder in the order of their names, none where it is absent."""
    return [file.read_bytes() for file in sorted(folder.glob('*'))]


def keep(data: bytes, kept: Path) -> None:
    """Write the input of a finding into the folder of its reader."""
    kept.mkdir(parents=True, exist_ok=True)
    (kept / hashlib.sha256(data).hexdigest()[:16]).write_bytes(data)
