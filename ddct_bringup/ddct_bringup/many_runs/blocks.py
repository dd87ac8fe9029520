# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""How many items a block has. It depends on no number of workers: blocks are files of a result."""

from collections.abc import Iterator, Sequence
from typing import TypeVar

_MOST = 2000
"""Largest number of items in a block."""
_BLOCKS = 50
"""Smallest number of blocks of much work, so that all workers end together."""
_TOGETHER_BLOCKS = 4
"""The same where items are computed together, and each costs less the more they are."""
_TOGETHER_LEAST, _TOGETHER_MOST = 256, 1000
"""Numbers of items computed together between which that smaller number of blocks is kept."""
Item = TypeVar('Item')


def block_size(items: int, *, together: bool = False) -> int:
    """Return the number of items in a block; `together` says that they are computed so."""
    size = min(_MOST, -(-items // _BLOCKS))
    if together:
        quarter = -(-items // _TOGETHER_BLOCKS)
        size = max(size, min(max(quarter, _TOGETHER_LEAST), _TOGETHER_MOST))
    return max(1, min(size, items))


def blocks_of(items: Sequence[Item], size: int) -> Iterator[Sequence[Item]]:
    """Yield the blocks of a sequence, in its order."""
    for first in range(0, len(items), size):
        yield items[first : first + size]
