# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Variables of an FMU for the sections of a controller file: inputs, outputs and parameters."""

import math
import re
from collections.abc import Mapping
from dataclasses import replace
from operator import attrgetter
from typing import Any

from ddct_controllers.from_file.fmu.fmu_controller import CLUTCH, ENGINE, FmuInput
from ddct_controllers.from_file.fmu.unit import Fmu, number_in
from ddct_controllers.interface import Measurement
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import REQUIRED, Option, close_name

SCALARS = {
    'slip_error_rpm': 'slip_error_rpm',
    'slip_speed_rad_s': 'slip_speed',
    'engine_speed_rad_s': 'engine_speed',
    'shaft_speed_rad_s': 'shaft_speed',
    'wheel_speed_rad_s': 'wheel_speed',
    'vehicle_speed_m_s': 'vehicle_speed',
    'engine_torque_n_m': 'engine_torque',
    'load_torque_n_m': 'load_torque',
    'open_loop_torque_n_m': 'open_loop_torque',
}
"""Attribute of Measurement by the name, with its unit, of a signal for an input."""
AHEAD = {
    'slip_reference_rad_s': 'slip_reference',
    'slip_reference_rate_rad_s2': 'slip_reference_rate',
}
"""
Attribute of Measurement by the name of a signal with preview.

An index is the number of periods ahead, as in `slip_reference_rad_s[i]`.
"""
_UNITS = {
    '_rpm': ('rpm', 'rev/min', 'r/min', '1/min'),
    '_rad_s': ('rad/s',),
    '_rad_s2': ('rad/s2',),
    '_m_s': ('m/s',),
    '_n_m': ('Nm',),
}
"""Spellings of a unit in tools, by the end of our name; dots, stars, hats, spaces are left out."""
_KINDS: Mapping[str, type] = {
    'Real': float,
    'Float64': float,
    'Float32': float,
    'Integer': int,
    'Int32': int,
    'Enumeration': int,
    'Boolean': bool,
    'String': str,
}
"""Python type of a start value by type of variable; inputs and outputs have that of a float."""


def fmu_variable(fmu: Fmu, section: str, name: str, causality: str = '') -> Any:
    """Return the variable that a section names; raise ParameterError for one of another kind."""
    key = f'fmu.{section}.{name}'
    variable = fmu.variables.get(name)
    if variable is None:
        known = [
            each.name
            for each in fmu.variables.values()
            if each.causality == (causality or 'parameter')
        ]
        hint = close_name(name, known or fmu.variables)
        raise ParameterError(
            f'{key}: {fmu.path.name} has no variable of this name: {hint}', key=key
        )
    kind = _KINDS.get(variable.type)
    if causality and (variable.causality, kind) != (causality, float):
        raise ParameterError(
            f'{key}: it is {variable.causality} of type {variable.type}: choose an {causality} '
            'that is a real number',
            key=key,
        )
    if variable.shape:
        raise ParameterError(f'{key}: it is an array: export its elements one by one', key=key)
    return variable


def fmu_input(variable: Any, ours: object) -> FmuInput:
    """Return the input that gets the signal `ours`; ParameterError for none or another unit."""
    key = f'fmu.inputs.{variable.name}'
    name, ahead = str(ours), 0
    if found := re.fullmatch(r'(\w+)\[(\d{1,3})\]', name):
        name, ahead = found[1], int(found[2])
    known = AHEAD if found else SCALARS | AHEAD
    if name not in known:
        raise ParameterError(f'{key} is {ours!r}: {close_name(name, known)}', key=key)
    _require_unit(key, variable, name)
    if name in SCALARS:
        return FmuInput(variable, attrgetter(SCALARS[name]))

    def read(measurement: Measurement) -> float:
        return getattr(measurement, AHEAD[name])[ahead]

    return FmuInput(variable, read, ahead)


def fmu_outputs(fmu: Fmu, section: Mapping[str, object]) -> Mapping[str, object]:
    """Return the output variables of the FMU by CLUTCH and ENGINE, the latter where it has one."""
    outputs: dict[str, object] = {}
    for name, ours in section.items():
        key = f'fmu.outputs.{name}'
        variable = fmu_variable(fmu, 'outputs', name, 'output')
        if ours not in (CLUTCH, ENGINE) or ours in outputs:
            raise ParameterError(
                f'{key} is {ours!r}: give {CLUTCH} or {ENGINE}, each once', key=key
            )
        _require_unit(key, variable, ours)
        outputs[ours] = variable
    if CLUTCH not in outputs:
        raise ParameterError(
            f'fmu.outputs: none is {CLUTCH}: map the clutch torque', key='fmu.outputs'
        )
    return outputs


def _require_unit(key: str, variable: Any, ours: str) -> None:
    """Raise ParameterError when the FMU declares another unit than that of our name."""
    stated = variable.unit or (variable.declaredType and variable.declaredType.unit) or '1'
    end = max((end for end in _UNITS if ours.endswith(end)), key=len)
    if stated != '1' and re.sub(r'[\s.*^·]', '', stated) not in _UNITS[end]:
        raise ParameterError(
            f'{key} is {ours}, but the FMU has it in {stated}: convert it there, or map another',
            key=key,
        )


def start_value(variable: Any, value: object) -> Option:
    """Return an option with the start value as default; ParameterError for a wrong type."""
    key = f'fmu.parameters.{variable.name}'
    settable = variable.initial in ('exact', 'approx') and variable.variability != 'constant'
    if not settable or variable.type not in _KINDS or variable.causality == 'structuralParameter':
        raise ParameterError(
            f'{key}: {variable.causality} of type {variable.type} takes no start value: choose a '
            'parameter',
            key=key,
        )
    kind = _KINDS[variable.type]
    option = Option(
        REQUIRED,
        variable.description or 'start value in the FMU',
        variable.unit or '',
        kind=kind,
        at_least=_end(key, 'min', variable.min),
        at_most=_end(key, 'max', variable.max),
    )
    return replace(option, default=option.checked(key, value))


def _end(key: str, name: str, stated: str | None) -> float | None:
    """Return one end of a parameter's range; raise ParameterError unless it is a number."""
    if not stated:
        return None
    end = number_in(stated)
    if math.isnan(end):
        raise ParameterError(
            f'{key}: its {name} in the FMU is {stated!r}: export it with a number', key=key
        )
    return end


def require_all_inputs(fmu: Fmu, given: set[str]) -> None:
    """Raise ParameterError for an input without a signal, but for types that can have none."""
    inputs = [each for each in fmu.variables.values() if each.causality == 'input']
    for variable in inputs:
        if variable.type in _KINDS and variable.name not in given:
            raise ParameterError(
                f'fmu.inputs: input {variable.name} of {fmu.path.name} is not among them: map it, '
                'or give it a value under parameters',
                key='fmu.inputs',
            )
