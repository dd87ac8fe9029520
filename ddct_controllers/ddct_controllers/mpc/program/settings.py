# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Cost, horizon, limits and solver of a predictive controller, and its options for them."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ddct_controllers.mpc.model.transmission_model import SLIP_SPEED
from ddct_controllers.mpc.qp.backend import BACKENDS, DEFAULT_BACKEND
from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.base.options import REQUIRED, Option, OptionGroup, Options, option, with_values
from ddct_plant.base.units import rad_s_from_rpm

MOST_STEPS = 1000
MOST = 1e6
"""Largest value of any other number, in its unit: far too large, but its products are finite."""
_LIMITS = {
    'highest_torque_n_m': Option(
        None, 'largest clutch torque request', 'N m', above=0.0, at_most=MOST
    ),
    'torque_rate_n_m_s': Option(
        None,
        'largest rate of the clutch torque request; it wins over the level',
        'N m/s',
        above=0.0,
        at_most=MOST,
    ),
    'lowest_slip_rpm': Option(
        None,
        'soft lower limit of the slip; 0 keeps the plates from passing each other',
        'rpm',
        at_least=-MOST,
        at_most=MOST,
    ),
}
_HORIZON = ('prediction_steps', 'control_steps', 'preview')
_SOLVER = ('backend', 'iteration_limit')
_CLUTCH_LIMITS = {'highest_torque_n_m': 'highest', 'torque_rate_n_m_s': 'rate_n_m_s'}


@dataclass(frozen=True)
class InputTerms:
    """Weights and limits of one input, a torque in N m."""

    move_weight: float = 0.0
    """Weight of each change from one period to the next, per N m."""
    target_weight: float = 0.0
    """Weight of the deviation from the target per N m: C_fOL for the clutch, 0 for the engine."""
    lowest: float = 0.0
    """Lower limit in N m; -inf for none."""
    highest: float = math.inf
    """Upper limit in N m; inf for none."""
    rate_n_m_s: float = math.inf
    """Largest rate of change in N m/s, which goes before both levels; inf for none."""

    def __post_init__(self) -> None:
        """Check every value; raise ParameterError that names a bad one."""
        for name in ('move_weight', 'target_weight'):
            require_number(f'MPC: {name}', getattr(self, name), at_least=0.0)
        if not self.lowest < self.highest:
            raise ParameterError(
                f'MPC: the lowest torque, {self.lowest:g} N m, must be below the highest, '
                f'{self.highest:g} N m',
                key='MPC: the lowest torque',
            )
        if not self.rate_n_m_s > 0.0:
            raise ParameterError(
                f'MPC: rate_n_m_s is {self.rate_n_m_s:g}: it must be above 0',
                key='MPC: rate_n_m_s',
            )


@dataclass(frozen=True)
class OutputTerms:
    """Weight and soft limits of one output, in its SI unit."""

    output: int
    """Row of the model's outputs, such as SLIP_SPEED."""
    weight: float
    """
    Weight of the deviation from the reference, per unit of the output; 0 leaves the output free.
    """
    final_weight: float = 0.0
    """
    Weight of the deviation at the end of the horizon, per unit of the output, beside `weight`.
    """
    lowest: float = -math.inf
    """Soft lower limit in the output's unit; -inf for none."""
    highest: float = math.inf
    """Soft upper limit in the output's unit; inf for none."""

    def __post_init__(self) -> None:
        """Check every value; raise ParameterError that names a bad one."""
        require_number('MPC: output weight', self.weight, at_least=0.0)
        require_number('MPC: final weight', self.final_weight, at_least=0.0)
        if not self.lowest < self.highest:
            raise ParameterError(
                f'MPC: the lowest output, {self.lowest:g}, must be below the highest, '
                f'{self.highest:g}',
                key='MPC: the lowest output',
            )


@dataclass(frozen=True)
class MpcSettings(OptionGroup, prefix='MPC: '):
    """
    Cost, horizon, limits and solver of a predictive controller.

    J = sum over i = 1..p of the outputs' squared weighted deviations from their references, plus
    sum over i = 0..m-1 of the inputs' squared weighted moves and deviations from their targets,
    plus at i = p the outputs' deviations once more with their final weights. Weights are squared
    together with the weighted quantity, as in MATLAB's mpcDesigner.
    """

    outputs: tuple[OutputTerms, ...]
    inputs: tuple[InputTerms, ...]
    """Weights and limits of the clutch torque request, then of C_m if it is commanded."""
    prediction_steps: int = option(
        REQUIRED,
        'p: number of periods over which the outputs are weighted',
        kind=int,
        at_least=1,
        at_most=MOST_STEPS,
    )
    control_steps: int = option(
        REQUIRED,
        'm: number of periods after which the inputs stay constant',
        kind=int,
        at_least=1,
        at_most=MOST_STEPS,
    )
    preview: bool = option(True, 'true uses the coming reference; false holds its present value')
    along_tangent: bool = False
    """Whether the slip reference continues along its tangent if there is no preview."""
    soft_limit_weight: float = option(
        1e4,
        "weight of the squared violation of an output's limit, in its unit, at each period ahead",
        above=0.0,
    )
    backend: str = option(DEFAULT_BACKEND, 'QP solver', choices=BACKENDS)
    iteration_limit: int | None = option(
        None,  # a time would differ by run
        'largest number of iterations of the QP solver per step',
        otherwise='1000 (daqp), 20000 (osqp)',
        kind=int,
        at_least=1,
        at_most=1_000_000,
    )

    def __post_init__(self) -> None:
        """Check every value; raise ParameterError that names a bad one and the valid range."""
        super().__post_init__()
        if self.control_steps > self.prediction_steps:
            raise ParameterError(
                f'MPC: control_steps is {self.control_steps}, longer than prediction_steps, '
                f'{self.prediction_steps}: choose at most that',
                key='MPC: control_steps',
            )
        if not self.outputs or not 1 <= len(self.inputs) <= 2:
            raise ParameterError('MPC: give at least one output, and one or two inputs', key='MPC')


def weight(default: float | None, meaning: str, otherwise: str = '') -> Any:
    """Return the field of an option group for a weight, squared together with its quantity."""
    return option(default, meaning, otherwise=otherwise, at_least=0.0, at_most=MOST)


def program_options(settings: MpcSettings) -> Options:
    """Return the options of horizon, limits and solver; their defaults are those of `settings`."""
    options = {**settings.options, **_LIMITS}
    if settings.along_tangent:
        meaning = f'{options["preview"].meaning} or continues along its tangent'
        options['preview'] = replace(options['preview'], meaning=meaning)
    return {key: options[key] for key in (*_HORIZON, *_LIMITS, *_SOLVER)}


def with_options(settings: MpcSettings, values: Mapping[str, Any]) -> MpcSettings:
    """
    Return `settings` changed by the values of its `program_options`.

    A horizon of None is that of `settings`.
    """
    if values['prediction_steps'] is None:
        values = {**values, 'prediction_steps': settings.prediction_steps}
    limits = {
        field: values[key] for key, field in _CLUTCH_LIMITS.items() if values[key] is not None
    }
    clutch = replace(settings.inputs[0], **limits)
    outputs = settings.outputs
    if values['lowest_slip_rpm'] is not None:
        lowest = rad_s_from_rpm(values['lowest_slip_rpm'])
        outputs = tuple(
            replace(terms, lowest=lowest) if terms.output == SLIP_SPEED else terms
            for terms in outputs
        )
    changed = with_values(settings, values)
    return replace(changed, inputs=(clutch, *settings.inputs[1:]), outputs=outputs)
