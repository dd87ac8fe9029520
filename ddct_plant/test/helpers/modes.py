# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The mode of a friction system in which a motion starts."""

from collections.abc import Sequence

import numpy as np

from ddct_plant.hybrid.friction_system import FrictionSystem, Signs


def mode_at(system: FrictionSystem, state: Sequence[float] | np.ndarray) -> Signs:
    """Return the signs of the slips in a state (n,); an element without slip sticks."""
    return tuple(np.sign(system.h @ state).astype(int).tolist())
