# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Edits of the bytes of a file: flipped bits, cuts, copies and words that are often trouble."""

import random
from collections.abc import Sequence
from dataclasses import dataclass

WORDS = (
    *(b'', b'nan', b'NaN', b'.inf', b'-1', b'0', b'1e999', b'-1e308', b'9' * 30, b'true', b'null'),
    *(b'[]', b'{}', b'""', b'[[]]', b'{a: b}', b'\x00', b'\xff', b'\xef\xbb\xbf'),
    *(b'=1+1', b'../../x', b'&a [*a]', b'# '),
    *(b'\xff\xff\xff\xff', b'\x00\x00\x00\x80', b'\n', b',,', b';', b': ', b'- '),
)
"""Texts and numbers that a reader may take for something else."""
FLIP, SET, CUT, COPY, INSERT, REPLACE = KINDS = range(6)
_LONGEST = 64
"""Longest cut or copied part in bytes."""


@dataclass(frozen=True)
class Edit:
    """One edit; every number suits bytes of any length."""

    kind: int
    place: int
    """Offset, taken modulo the length."""
    value: int
    """Bit, byte, length, or number of a word."""


def edited(data: bytes, edits: Sequence[Edit]) -> bytes:
    """Return bytes after edits, one after the other."""
    for edit in edits:
        data = _edited(data, edit)
    return data


def random_edits(source: random.Random) -> list[Edit]:
    """Return a few random edits."""
    return [
        Edit(source.choice(KINDS), source.randrange(2**31), source.randrange(2**16))
        for _ in range(source.choice((1, 1, 1, 2, 3, 8)))
    ]


def _edited(data: bytes, edit: Edit) -> bytes:
    place = edit.place % (len(data) + 1)
    before, after = data[:place], data[place:]
    part = after[: 1 + edit.value % _LONGEST]
    word = WORDS[edit.value % len(WORDS)]
    if edit.kind == FLIP and after:
        return before + bytes([after[0] ^ (1 << edit.value % 8)]) + after[1:]
    if edit.kind == SET and after:
        return before + bytes([edit.value % 256]) + after[1:]
    if edit.kind == CUT:
        return before + after[len(part) :] if edit.value % 8 else before
    if edit.kind == COPY:
        return before + part + part + after
    if edit.kind == REPLACE:
        return before + word + after[len(part) :]
    return before + word + after
