# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Names of the states, inputs or outputs of a linear model, and their indices."""

from collections.abc import Iterator
from dataclasses import dataclass

from ddct_plant.base.errors import ParameterError


@dataclass(frozen=True)
class Names:
    """
    Names in the order of the rows or columns that they stand for.

    A model has one for its states, so that other modules use neither the index of a state nor
    the number of states.
    """

    names: tuple[str, ...]
    """Names, each once."""

    def __post_init__(self) -> None:
        """Check that no name occurs twice; raise ParameterError otherwise."""
        for name in self.names:
            if self.names.count(name) > 1:
                raise ParameterError(
                    f'the name {name} stands twice: give each name once', key=name
                )

    def __len__(self) -> int:
        """Return the number of names."""
        return len(self.names)

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names in their order."""
        return iter(self.names)

    def __getitem__(self, name: str) -> int:
        """Return the index of a name; raise ParameterError for an unknown one."""
        if name not in self.names:
            raise ParameterError(
                f'there is no {name}: choose from {", ".join(self.names)}', key=name
            )
        return self.names.index(name)

    def __add__(self, more: 'Names') -> 'Names':
        """Return these names, then those of `more`."""
        return Names((*self.names, *more.names))

    def places(self, *names: str) -> list[int]:
        """Return the indices of some names, in the order of the arguments."""
        return [self[name] for name in names]

    def column(self, name: str) -> slice:
        """Return the slice of one row or column, which keeps a matrix a matrix."""
        return slice(self[name], self[name] + 1)
