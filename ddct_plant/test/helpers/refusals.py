# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Requirement on an error for users: its type, key and place, whatever its words are."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from ddct_plant.base.errors import DdctError


@contextmanager
def refused(
    kind: type[DdctError], key: str = '', place: str = ''
) -> Iterator[pytest.ExceptionInfo[DdctError]]:
    """
    Require an error of a kind with this key, whose place ends as given.

    Its text must be one line that begins with the place and has the last name of the key, so that
    the user can find what to change.
    """
    with pytest.raises(kind) as caught:
        yield caught
    error = caught.value
    assert (error.key, error.place[-len(place) :] if place else '') == (key, place), error
    assert key.rpartition('.')[2] in str(error) and str(error).startswith(error.place), error
    assert '\n' not in str(error), error
    # The traceback has this frame: without its variables the error frees what it refers to.
    del caught, error
