"""A sampled linear system as it runs: one matrix product per period."""

import numpy as np

from ddct_plant.linear.lti import StateSpace


class DiscreteFilter:
    """y_k = c x_k + d u_k, x_(k+1) = a x_k + b u_k, with one output and any number of inputs."""

    def __init__(self, model: StateSpace) -> None:
        """Start at x = 0."""
        self._state_update = np.hstack([model.a, model.b])
        self._output = np.hstack([model.c, model.d])[0]
        self._states = len(model.a)
        self._state_and_inputs = np.zeros(len(self._output))

    def reset(self, state: np.ndarray | float = 0.0) -> None:
        """Set x to `state`, (n,), by default zero."""
        self._state_and_inputs[: self._states] = state

    def update(self, *inputs: float) -> float:
        """Return the output of this period and advance the state to the next one."""
        values = self._state_and_inputs
        values[self._states :] = inputs
        output = float(self._output @ values)
        values[: self._states] = self._state_update @ values
        return output
