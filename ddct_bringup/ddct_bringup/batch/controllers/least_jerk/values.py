# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Values of R runs, of which some change at a step."""

from collections.abc import Iterable
from typing import Any

import numpy as np


class Values:
    """Arrays (R,) that are set where a mask (R,) of bool has its runs."""

    def put(self, which: np.ndarray, **values: Any) -> None:
        """Set the values called so in the runs of the mask."""
        for name, value in values.items():
            setattr(self, name, np.where(which, value, getattr(self, name)))


def numbers(parts: Iterable[Any], name: str) -> np.ndarray:
    """Return the number called `name` of each part, (R,)."""
    return np.array([getattr(each, name) for each in parts], dtype=float)
