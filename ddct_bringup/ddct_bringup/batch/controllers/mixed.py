# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers of several kinds as the feedback of one stack of runs."""

from collections.abc import Hashable, Sequence

import numpy as np

from ddct_bringup.batch.batchable import kind_of
from ddct_bringup.batch.controllers.interface import Measured, StackedController
from ddct_bringup.batch.stacks import rows_of
from ddct_controllers.interface import Controller
from ddct_plant.scenario.settings import KnownSettings

_Kind = tuple[type[StackedController], int, Hashable]
"""Kind of a controller, its preview steps, and what those that are computed together share."""


class MixedControllers:
    """Controllers of R runs, those of one kind together."""

    def __init__(self, controllers: Sequence[Controller], known: Sequence[KnownSettings]) -> None:
        """Take the controllers of R runs with these known settings."""
        kinds = {id(each): _kind(each) for each in controllers}
        places: dict[_Kind, list[int]] = {}
        for place, controller in enumerate(controllers):
            places.setdefault(kinds[id(controller)], []).append(place)
        self._count = len(controllers)
        self.preview_steps = max(each.preview_steps for each in controllers)
        """Largest number of steps that a controller looks ahead."""
        self._parts = [
            (
                rows_of(of_kind),
                kind[0].of(
                    [controllers[each] for each in of_kind], [known[each] for each in of_kind]
                ),
                kind[1],
            )
            for kind, of_kind in places.items()
        ]

    def update(self, measured: Measured) -> np.ndarray:
        """Advance by one period; return the feedback torques in N m, (R,)."""
        if len(self._parts) == 1:
            return self._parts[0][1].update(measured)
        torque = np.zeros(self._count)
        for rows, stack, preview_steps in self._parts:
            torque[rows] = stack.update(measured.of_rows(rows, preview_steps))
        return torque


def _kind(controller: Controller) -> _Kind:
    kind = kind_of(controller)
    return kind, controller.preview_steps, kind.key(controller)
