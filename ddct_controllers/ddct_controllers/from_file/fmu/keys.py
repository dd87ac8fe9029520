# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The keys of a controller file for an FMU, as Simulink and Modelica tools export them."""

from ddct_controllers.from_file.controller_file import ControllerFile, mapping, option_name
from ddct_controllers.from_file.fmu.fmu_controller import FmuController
from ddct_controllers.from_file.fmu.unit import Fmu
from ddct_controllers.from_file.fmu.variables import (
    fmu_input,
    fmu_outputs,
    fmu_variable,
    require_all_inputs,
    start_value,
)
from ddct_controllers.interface import Controller, ControllerContext, ControllerSpec
from ddct_plant.base.errors import ParameterError

KIND = 'fmu'


def fmu_spec(file: ControllerFile) -> ControllerSpec[Controller]:
    """Return the controller behind `fmu`; its options are the start values in `parameters`."""
    keys = mapping(
        KIND, file.keys(KIND)[KIND], ('file', 'inputs', 'outputs'), optional=('parameters',)
    )
    path = file.named_file(KIND, keys['file'], 'an FMU')
    try:
        fmu = Fmu(path)
    except ParameterError as error:
        raise ParameterError(f'fmu.file: {error}', key='fmu.file') from error
    inputs = [
        fmu_input(fmu_variable(fmu, 'inputs', name, 'input'), ours)
        for name, ours in mapping('fmu.inputs', keys['inputs']).items()
    ]
    outputs = fmu_outputs(fmu, mapping('fmu.outputs', keys['outputs']))
    given = mapping('fmu.parameters', keys.get('parameters') or {})
    started = [fmu_variable(fmu, 'parameters', name) for name in given]
    options = {
        option_name(variable.name): start_value(variable, given[variable.name])
        for variable in started
    }
    if len(options) < len(started):
        raise ParameterError(
            'fmu.parameters: two names differ only in their dots and brackets: keep one',
            key='fmu.parameters',
        )
    require_all_inputs(fmu, {each.variable.name for each in inputs} | set(given))

    def make(context: ControllerContext) -> Controller:
        starts = [
            (variable, context.gains[name])
            for variable, name in zip(started, options, strict=True)
        ]
        return FmuController(file, fmu, inputs, outputs, starts)

    code = file.compiled_code(KIND, path)
    return ControllerSpec(file.name, make, options, compiled=code)
