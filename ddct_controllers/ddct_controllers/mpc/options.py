"""Keys that a scenario may give a predictive controller, in `controllers.<name>`."""

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

from ddct_controllers.mpc.qp.factory import BACKENDS
from ddct_controllers.mpc.settings import InputTerms, MpcSettings
from ddct_plant.checks import require_choice, require_number
from ddct_plant.errors import ParameterError

OPTIONS = {
    'prediction_steps': 'periods over which outputs are weighted',
    'control_steps': 'periods after which the inputs stay constant',
    'preview': 'true uses the coming reference, false holds its present value',
    'highest_torque_n_m': 'largest clutch torque request',
    'torque_rate_n_m_s': 'largest rate of the clutch torque request',
    'backend': 'QP solver: ' + ' or '.join(BACKENDS),
    'iteration_limit': 'of the QP solver, per step',
}
"""Keys and what they mean."""


def with_options(
    name: str, settings: MpcSettings, options: Mapping[str, Any], own: Sequence[str] = ()
) -> MpcSettings:
    """
    Return `settings` changed by the scenario's section `controllers.<name>`.

    `own` are further keys of this controller; it reads them itself.
    """
    unknown = set(options) - set(OPTIONS) - set(own)
    if unknown:
        raise ParameterError(
            f'controllers.{name}.{min(unknown)} is not a key of {name}: it has '
            f'{", ".join((*own, *OPTIONS))}'
        )
    changes: dict[str, Any] = {}
    for key in ('prediction_steps', 'control_steps', 'iteration_limit'):
        if key in options:
            changes[key] = _whole_number(f'controllers.{name}.{key}', options[key])
    if 'preview' in options:
        changes['preview'] = _switch(f'controllers.{name}.preview', options['preview'])
    if 'backend' in options:
        require_choice(f'controllers.{name}.backend', str(options['backend']), BACKENDS)
        changes['backend'] = options['backend']
    clutch = _clutch_limits(name, settings.inputs[0], options)
    return dataclasses.replace(settings, inputs=(clutch, *settings.inputs[1:]), **changes)


def number_option(
    name: str,
    options: Mapping[str, Any],
    key: str,
    default: float,
    *,
    above: float | None = None,
    at_least: float | None = None,
) -> float:
    """Return a key of `controllers.<name>`, checked like `require_number`, or its default."""
    value = options.get(key, default)
    return require_number(f'controllers.{name}.{key}', value, above=above, at_least=at_least)


def _clutch_limits(name: str, clutch: InputTerms, options: Mapping[str, Any]) -> InputTerms:
    limits = {'highest': 'highest_torque_n_m', 'rate_n_m_s': 'torque_rate_n_m_s'}
    given = {
        field: require_number(f'controllers.{name}.{key}', options[key], unit='N m', above=0.0)
        for field, key in limits.items()
        if key in options
    }
    return dataclasses.replace(clutch, **given)


def _whole_number(name: str, value: Any) -> int:
    if require_number(name, value, at_least=1) % 1:
        raise ParameterError(f'{name} is {value!r}: give a whole number')
    return int(value)


def _switch(name: str, value: object) -> bool:
    if not isinstance(value, bool):
        raise ParameterError(f'{name} is {value!r}: give true or false')
    return value
