"""What differs from run to run, as arrays with one column for each run."""

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import fields
from types import SimpleNamespace
from typing import Any

import numpy as np


def stacked(things: Sequence[Any]) -> Any:
    """
    Return something with the fields of dataclasses, each an array, (R,).

    Equations that only read fields take it as one of them.
    """
    names = [field.name for field in fields(things[0])]
    columns = {name: np.array([getattr(each, name) for each in things]) for name in names}
    return SimpleNamespace(**columns)


def distinct(keys: Iterable[Hashable]) -> tuple[list[int], np.ndarray]:
    """Return where each key stands first, and for each key its place among those, (R,)."""
    places: dict[Any, int] = {}
    first: list[int] = []
    inverse = []
    for index, key in enumerate(keys):
        if key not in places:
            places[key] = len(first)
            first.append(index)
        inverse.append(places[key])
    return first, np.array(inverse)


def product(matrix: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """
    Return matrix @ columns, (m, R), of one matrix (m, n) or one for each run (m, n, R).

    BLAS is faster with one matrix, but rounds a column by what stands beside it.
    """
    return np.einsum('ijr,jr->ir' if matrix.ndim == 3 else 'ij,jr->ir', matrix, columns)
