# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What is done with items, such as runs: in blocks, parts of a sequence of them."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Generic, TypeVar

from ddct_plant.base.errors import DdctError

Item = TypeVar('Item')
Result = TypeVar('Result')


class Work(ABC, Generic[Item, Result]):
    """
    Work on items, block by block; workers in other processes have a copy of it.

    The result of a block is that of its parts joined, to the last bit.
    """

    @abstractmethod
    def of_block(self, items: Sequence[Item]) -> Result:
        """Return the result of a block."""

    @abstractmethod
    def joined(self, parts: Sequence[Result]) -> Result:
        """Return the result of a block from those of its parts, in their order."""

    @abstractmethod
    def without_result(self, item: Item, why: str) -> Result:
        """Return the result of an item whose process ends each time; `why` is a clause."""

    def error(self, items: Sequence[Item], error: Exception) -> Exception:
        """Return the exception to raise for one that `of_block` has raised."""
        del items
        return error


@dataclass(frozen=True)
class Each(Work[Item, list[Result]]):
    """A function of each item, whose result is in a list."""

    function: Callable[[Item], Result]

    def of_block(self, items: Sequence[Item]) -> list[Result]:
        """Return the result of each item."""
        return [self.function(item) for item in items]

    def joined(self, parts: Sequence[list[Result]]) -> list[Result]:
        """Return the results of all parts."""
        return [*chain.from_iterable(parts)]

    def without_result(self, item: Item, why: str) -> list[Result]:
        """Raise DdctError: there is no result."""
        del item
        raise DdctError(f'{why}: free some memory if it ran out, and start again')
