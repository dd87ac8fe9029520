"""Options of every predictive controller, in the scenario's section `controllers.<name>`."""

import dataclasses
from collections.abc import Mapping
from typing import Any

from ddct_controllers.mpc.model.transmission_model import SLIP_SPEED
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_controllers.mpc.qp.backend import BACKENDS
from ddct_plant.base.options import Option, Options, option
from ddct_plant.base.units import rad_s_from_rpm

MOST_STEPS = 1000
MOST = 1e6
"""Largest value of any other number, in its unit: far too large, but its products are finite."""
_AS_THEY_ARE = ('prediction_steps', 'control_steps', 'preview', 'backend', 'iteration_limit')
_CLUTCH_LIMITS = {'highest_torque_n_m': 'highest', 'torque_rate_n_m_s': 'rate_n_m_s'}


def program_options(settings: MpcSettings) -> Options:
    """Return the options of horizon, limits and solver; their defaults are those of `settings`."""
    return {
        'prediction_steps': Option(
            settings.prediction_steps,
            'p: number of periods over which the outputs are weighted',
            at_least=1,
            at_most=MOST_STEPS,
        ),
        'control_steps': Option(
            settings.control_steps,
            'm: number of periods after which the inputs stay constant',
            at_least=1,
            at_most=MOST_STEPS,
        ),
        'preview': Option(
            settings.preview,
            'true uses the coming reference; false holds its present value'
            + (' or continues along its tangent' if settings.along_tangent else ''),
        ),
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
        'backend': Option(settings.backend, 'QP solver', choices=BACKENDS),
        'iteration_limit': Option(
            None,
            'largest number of iterations of the QP solver per step',
            otherwise='1000 (daqp), 20000 (osqp)',
            kind=int,
            at_least=1,
            at_most=1_000_000,
        ),
    }


def weight(default: float | None, meaning: str, otherwise: str = '') -> Any:
    """Return the field of an option group for a weight, which is squared with what it weighs."""
    return option(default, meaning, otherwise=otherwise, at_least=0.0, at_most=MOST)


def with_options(settings: MpcSettings, values: Mapping[str, Any]) -> MpcSettings:
    """Return `settings` changed by the values of its `program_options`."""
    limits = {
        field: values[key] for key, field in _CLUTCH_LIMITS.items() if values[key] is not None
    }
    clutch = dataclasses.replace(settings.inputs[0], **limits)
    outputs = settings.outputs
    if values['lowest_slip_rpm'] is not None:
        lowest = rad_s_from_rpm(values['lowest_slip_rpm'])
        outputs = tuple(
            dataclasses.replace(terms, lowest=lowest) if terms.output == SLIP_SPEED else terms
            for terms in outputs
        )
    return dataclasses.replace(
        settings,
        inputs=(clutch, *settings.inputs[1:]),
        outputs=outputs,
        **{key: values[key] for key in _AS_THEY_ARE},
    )
