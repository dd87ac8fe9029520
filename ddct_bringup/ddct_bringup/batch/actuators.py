"""The actuators of many runs: `Actuator` over columns."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.batch.columns import distinct, product
from ddct_plant.base.timebase import SUBSTEPS
from ddct_plant.models.actuator import ActuatorParameters, at_rest, lifted

_STATES = slice(0, 4)
_EARLIER, _LATER = 4, 5
"""Rows of what a period takes: G_a's states, and the two requests in effect within it."""


class Actuators:
    """R actuators; where a delay is whole periods its earlier request has no effect."""

    def __init__(
        self, parameters: Sequence[ActuatorParameters], requests: np.ndarray, steps: int
    ) -> None:
        """Start at rest on requests, (R,) in N m; they last `steps` periods."""
        first, places = distinct(parameters)
        periods = np.array([each.delay_substeps // SUBSTEPS for each in parameters])
        made = [_matrices(parameters[index]) for index in first]
        updates, nodes, rest = (np.stack(each) for each in zip(*made, strict=True))
        self.nodes = nodes[places]
        """(R, 11, 6): the torque at 0, 1, ..., 10 ms by `values`."""
        rows = np.concatenate([updates, nodes[:, -1:]], axis=1).transpose(1, 2, 0)
        self._rows = rows[..., 0] if len(first) == 1 else np.take(rows, places, axis=-1)
        delayed = np.maximum(requests, 0.0)
        self.values = np.zeros((_LATER + 1, len(parameters)))
        """(6, R): states, and once `ask` has been called the requests in effect."""
        self.values[_STATES] = np.take(rest.T, places, axis=-1) * delayed
        self._before = int(periods.max()) + 1
        self._asked = np.empty((self._before + steps, len(parameters)))
        self._asked[: self._before] = delayed
        alike = bool((periods == periods[0]).all())
        self._later = self._before - (int(periods[0]) if alike else periods)
        self._columns = slice(None) if alike else np.arange(len(parameters))

    def ask(self, step: int, requests: np.ndarray) -> None:
        """Take the requests of step k in, (R,) in N m, cut off below zero."""
        np.maximum(requests, 0.0, out=self._asked[self._before + step])
        later = self._later + step
        self.values[_EARLIER] = self._asked[later - 1, self._columns]
        self.values[_LATER] = self._asked[later, self._columns]

    def advance(self) -> np.ndarray:
        """Go to the end of the period; return the torque there, (R,) in N m."""
        followed = product(self._rows, self.values)
        self.values[_STATES] = followed[:-1]
        return followed[-1]


def _matrices(parameters: ActuatorParameters) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the (4, 6) next state, the (11, 6) nodes and the state of rest for 1 N m."""
    model, late = parameters.dynamics(), parameters.delay_substeps % SUBSTEPS
    update, nodes = lifted(model, late)
    if not late:
        update, nodes = (np.insert(each, _EARLIER, 0.0, axis=1) for each in (update, nodes))
    return update, nodes, at_rest(model, 1.0)
