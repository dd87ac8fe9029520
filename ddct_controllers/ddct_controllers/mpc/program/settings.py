"""What a predictive controller minimises, over which horizon and within which limits."""

import math
from dataclasses import dataclass

from ddct_controllers.mpc.qp.backend import BACKENDS, DEFAULT_BACKEND
from ddct_plant.base.errors import ParameterError, require_choice, require_number


@dataclass(frozen=True)
class InputTerms:
    """Weights and limits of one input, a torque in N m."""

    move_weight: float = 0.0
    """Weight of each change from one period to the next, per N m."""
    target_weight: float = 0.0
    """Weight of the deviation from the target per N m: C_fOL for the clutch, 0 for the engine."""
    lowest: float = 0.0
    """Limit in N m; -inf for none."""
    highest: float = math.inf
    """Limit in N m; inf for none."""
    rate_n_m_s: float = math.inf
    """Largest rate of change, which goes before both levels; inf for none."""

    def __post_init__(self) -> None:
        """Check every value; raise ParameterError that names a bad one."""
        for name in ('move_weight', 'target_weight'):
            require_number(f'MPC: {name}', getattr(self, name), at_least=0.0)
        if not self.lowest < self.highest:
            raise ParameterError(
                f'MPC: the lowest torque, {self.lowest:g} N m, must be below the highest, '
                f'{self.highest:g} N m'
            )
        if not self.rate_n_m_s > 0.0:
            raise ParameterError(f'MPC: rate_n_m_s is {self.rate_n_m_s:g}: it must be above 0')


@dataclass(frozen=True)
class OutputTerms:
    """Weight and soft limits of one output, in its SI unit."""

    output: int
    """Row of the model's outputs, such as SLIP_SPEED."""
    weight: float
    """Weight of the deviation from the reference, per unit; 0 leaves the output free."""
    final_weight: float = 0.0
    """Weight of the deviation at the end of the horizon, beside `weight`."""
    lowest: float = -math.inf
    """Soft limit; -inf for none."""
    highest: float = math.inf
    """Soft limit; inf for none."""

    def __post_init__(self) -> None:
        """Check every value; raise ParameterError that names a bad one."""
        require_number('MPC: output weight', self.weight, at_least=0.0)
        require_number('MPC: final weight', self.final_weight, at_least=0.0)
        if not self.lowest < self.highest:
            raise ParameterError(
                f'MPC: the lowest output, {self.lowest:g}, must be below the highest, '
                f'{self.highest:g}'
            )


@dataclass(frozen=True)
class MpcSettings:
    """
    Cost, horizon, limits and solver of a predictive controller.

    J = sum over i = 1..p of the outputs' squared weighted deviations from their references, plus
    sum over i = 0..m-1 of the inputs' squared weighted moves and deviations from their targets,
    plus at i = p the outputs' deviations once more with their final weights.
    Weights are squared with what they weigh, as in MATLAB's mpcDesigner.
    """

    prediction_steps: int
    """p, how many periods ahead outputs are weighted."""
    control_steps: int
    """m, after how many periods the inputs stay constant."""
    outputs: tuple[OutputTerms, ...]
    inputs: tuple[InputTerms, ...]
    """The clutch torque request, then C_m if it is commanded."""
    preview: bool = True
    """Whether the coming reference is used; otherwise its present value is held."""
    along_tangent: bool = False
    """Whether the slip reference continues along its tangent if there is no preview."""
    soft_limit_weight: float = 1e4
    """Weight of the squared violation of an output's limit, in its unit, at each period ahead."""
    backend: str = DEFAULT_BACKEND
    """Which QP solver."""
    iteration_limit: int | None = None
    """Limit of the solver per step, None for its ITERATION_LIMITS; a time would differ by run."""

    def __post_init__(self) -> None:
        """Check every value; raise ParameterError that names a bad one and what fits."""
        for name in ('prediction_steps', 'control_steps', 'iteration_limit'):
            value = getattr(self, name)
            if value is None and name == 'iteration_limit':
                continue
            if isinstance(value, bool) or not isinstance(value, int) or value < 1:
                raise ParameterError(f'MPC: {name} is {value!r}: give a whole number above 0')
        if self.control_steps > self.prediction_steps:
            raise ParameterError(
                f'MPC: control_steps is {self.control_steps}, longer than prediction_steps, '
                f'{self.prediction_steps}: choose at most that'
            )
        require_choice('QP backend', self.backend, BACKENDS)
        require_number('MPC: soft_limit_weight', self.soft_limit_weight, above=0.0)
        if not self.outputs or not 1 <= len(self.inputs) <= 2:
            raise ParameterError('MPC: give at least one output, and one or two inputs')
