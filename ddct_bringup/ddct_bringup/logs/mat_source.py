# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A MAT file of version 5 as a log: its vectors, those in structures with dots in their names."""

from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cached_property
from typing import Any

import numpy as np
import scipy

from ddct_bringup.logs.array_table import ArrayTable, present
from ddct_bringup.logs.sources import LogSource, LogTable
from ddct_plant.base.errors import FOREIGN_FAILURES, ParameterError


class MatSource(LogSource):
    """Vectors of numbers in a MAT file."""

    def units(self) -> Mapping[str, str]:
        """Return the names of the vectors, without units."""
        return dict.fromkeys(self._vectors, '')

    def table(
        self,
        names: Iterable[str],
        *,
        date_times: Collection[str] = (),
        optional: Collection[str] = (),
    ) -> LogTable:
        """Return vectors of one length; raise ParameterError for others."""
        if date_times:
            raise ParameterError(
                'a MAT file has no dates with times: give the unit of its time', place=self.path
            )
        found = present(self.path, names, self._vectors, optional)
        columns = {name: self._vectors[name] for name in found}
        lengths = {name: len(values) for name, values in columns.items()}
        first = found[0]
        for name, length in lengths.items():
            if length != lengths[first]:
                raise ParameterError(
                    f'{name} has {length} values and {first} {lengths[first]}: give vectors of '
                    'one length',
                    key=name,
                    place=self.path,
                )
        return ArrayTable(self.path, columns)

    @cached_property
    def _vectors(self) -> Mapping[str, np.ndarray]:
        try:
            content = scipy.io.loadmat(
                self.path, squeeze_me=True, struct_as_record=False, appendmat=False
            )
        except NotImplementedError as error:
            raise ParameterError(
                'a MAT file of version 7.3: save it with -v7', place=self.path
            ) from error
        except OSError as error:
            raise ParameterError(
                f'cannot be read ({error.strerror or error})', place=self.path
            ) from error
        except FOREIGN_FAILURES as error:  # of a damaged file scipy raises many kinds
            raise ParameterError(
                f'it is no MAT file ({type(error).__name__}: {error}): save it with -v7',
                place=self.path,
            ) from error
        return dict(_vectors_in(content, ''))


def _vectors_in(content: Mapping[str, Any], before: str) -> Iterator[tuple[str, np.ndarray]]:
    """Yield the vectors of numbers and their names, in nested structures too."""
    for name, value in content.items():
        if name.startswith('__'):
            continue
        if hasattr(value, '_fieldnames'):
            inside = {field: getattr(value, field) for field in value._fieldnames}
            yield from _vectors_in(inside, f'{before}{name}.')
        elif isinstance(value, np.ndarray) and value.ndim == 1 and value.dtype.kind in 'biuf':
            yield f'{before}{name}', value.astype(float)
