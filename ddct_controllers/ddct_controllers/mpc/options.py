"""Keys that a scenario may give a predictive controller, in `controllers.<name>`."""

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

from ddct_controllers.mpc.model.transmission_model import SLIP_SPEED
from ddct_controllers.mpc.program.settings import InputTerms, MpcSettings, OutputTerms
from ddct_controllers.mpc.qp.backend import BACKENDS
from ddct_controllers.option_keys import require_known_keys
from ddct_plant.base.checks import require_choice, require_number
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.units import rad_s_from_rpm

OPTIONS = {
    'prediction_steps': 'periods over which outputs are weighted',
    'control_steps': 'periods after which the inputs stay constant',
    'preview': 'true uses the coming reference, false holds its present value',
    'highest_torque_n_m': 'largest clutch torque request',
    'torque_rate_n_m_s': 'largest rate of the clutch torque request; it goes before the level',
    'lowest_slip_rpm': 'soft lower limit of the slip; 0 keeps the plates from passing each other',
    'backend': 'QP solver: ' + ' or '.join(BACKENDS),
    'iteration_limit': 'of the QP solver, per step',
}
"""Keys and what they mean."""
MOST_STEPS = {'prediction_steps': 1000, 'control_steps': 1000, 'iteration_limit': 1_000_000}
MOST = 1e6
"""Of every other number, in its unit: far beyond all sense, and all products of it are finite."""


def with_options(
    name: str, settings: MpcSettings, options: Mapping[str, Any], own: Sequence[str] = ()
) -> MpcSettings:
    """
    Return `settings` changed by the scenario's section `controllers.<name>`.

    `own` are further keys of this controller; it reads them itself.
    """
    require_known_keys(name, options, (*own, *OPTIONS))
    changes: dict[str, Any] = {}
    for key, most in MOST_STEPS.items():
        if key in options:
            changes[key] = _whole_number(f'controllers.{name}.{key}', options[key], most)
    changes['preview'] = switch_option(name, options, 'preview', settings.preview)
    if 'backend' in options:
        require_choice(f'controllers.{name}.backend', str(options['backend']), BACKENDS)
        changes['backend'] = options['backend']
    if 'lowest_slip_rpm' in options:
        lowest = number_option(name, options, 'lowest_slip_rpm', 0.0, at_least=-MOST)
        changes['outputs'] = _with_lowest_slip(settings.outputs, rad_s_from_rpm(lowest))
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
    at_most: float = MOST,
) -> float:
    """Return a key of `controllers.<name>`, checked like `require_number`, or its default."""
    value = options.get(key, default)
    return require_number(
        f'controllers.{name}.{key}', value, above=above, at_least=at_least, at_most=at_most
    )


def switch_option(name: str, options: Mapping[str, Any], key: str, default: bool) -> bool:
    """Return a key of `controllers.<name>`, true or false, or its default."""
    value = options.get(key, default)
    if not isinstance(value, bool):
        raise ParameterError(f'controllers.{name}.{key} is {value!r}: give true or false')
    return value


def _clutch_limits(name: str, clutch: InputTerms, options: Mapping[str, Any]) -> InputTerms:
    limits = {
        'highest': ('highest_torque_n_m', 'N m'),
        'rate_n_m_s': ('torque_rate_n_m_s', 'N m/s'),
    }
    given = {
        field: require_number(
            f'controllers.{name}.{key}', options[key], unit=unit, above=0.0, at_most=MOST
        )
        for field, (key, unit) in limits.items()
        if key in options
    }
    return dataclasses.replace(clutch, **given)


def _with_lowest_slip(
    outputs: tuple[OutputTerms, ...], lowest_rad_s: float
) -> tuple[OutputTerms, ...]:
    return tuple(
        dataclasses.replace(terms, lowest=lowest_rad_s) if terms.output == SLIP_SPEED else terms
        for terms in outputs
    )


def _whole_number(name: str, value: Any, most: int) -> int:
    if require_number(name, value, at_least=1, at_most=most) % 1:
        raise ParameterError(f'{name} is {value!r}: give a whole number')
    return int(value)
