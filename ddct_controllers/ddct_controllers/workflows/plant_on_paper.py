# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The linear plant of a scenario as equations with numbers."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Literal

import numpy as np

from ddct_plant.files.json_records import Inline
from ddct_plant.linear.cascade import Factor
from ddct_plant.linear.lti import FactoredTransferFunction
from ddct_plant.models import driveline_model
from ddct_plant.models.driveline_model import (
    clutch_to_slip,
    driveline_matrices,
    engine_to_slip,
    load_to_slip,
)
from ddct_plant.models.parameters import SYMBOLS_AND_UNITS
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.scenario import Scenario

_SYMBOLS_AND_UNITS = {
    'engine_speed': ('w_m', 'rad/s'),
    'shaft_speed': ('w_p', 'rad/s'),
    'wheel_speed': ('w_r', 'rad/s'),
    'twist': ('theta_sr', 'rad'),
    'engine_torque': ('C_m', 'N m'),
    'clutch_torque': ('C_f', 'N m'),
    'load_torque': ('C_load', 'N m'),
    'slip_speed': ('w_d', 'rad/s'),
    'torsion_speed': ('w_sr', 'rad/s'),
}
STATES, INPUTS, OUTPUTS = (
    dict(_SYMBOLS_AND_UNITS[name] for name in names)
    for names in (driveline_model.STATES, driveline_model.TORQUES, driveline_model.OUTPUTS)
)
"""Unit of each state, input and output of the driveline by its symbol."""
_STATIC_INPUTS = {'C_m': '1', 'C_load': '1', 'w_m': 'N m s/rad', 'w_p': 'N m s/rad'}
MATRICES: tuple[Literal['A', 'B', 'C', 'D'], ...] = ('A', 'B', 'C', 'D')


@dataclass(frozen=True)
class ParameterEntry:
    """One parameter of the driveline."""

    name: str
    """Key in the section `driveline` of a scenario."""
    value: float
    unit: str


@dataclass(frozen=True)
class StateSpaceEntry:
    """The driveline as x' = A x + B u, y = C x + D u."""

    states: dict[str, str]
    """Units by symbol, in the order of the rows of A."""
    inputs: dict[str, str]
    outputs: dict[str, str]
    A: list[list[float]]
    B: list[list[float]]
    C: list[list[float]]
    D: list[list[float]]


@dataclass(frozen=True)
class PlantFunction:
    """One transfer function from an input to an output."""

    input: str
    output: str
    function: Inline[FactoredTransferFunction]
    num: list[float]
    """Coefficients with the gain, the highest power first."""
    den: list[float]


@dataclass(frozen=True)
class StaticFactor:
    """Factor of one signal in C_fOL."""

    factor: float
    unit: str


@dataclass(frozen=True)
class PlantOnPaper:
    """The linear plant of a scenario, as it is written as JSON."""

    scenario: str
    parameters: dict[str, ParameterEntry]
    """Parameters by their symbol in the thesis."""
    state_space: StateSpaceEntry
    transfer_functions: dict[str, PlantFunction]
    """Transfer functions by their symbol."""
    actuator_delay_s: float
    c_fol: dict[str, StaticFactor]
    """Factors of the static torque by signal."""


def plant_on_paper(scenario: Scenario) -> PlantOnPaper:
    """
    Return the linear plant with its names and units, plain enough for JSON.

    `transfer_functions` have the factors that the thesis prints, and polynomials with the highest
    power first. `c_fol` has the factors of the static torque: C_fOL is their sum of products.
    """
    driveline = scenario.driveline
    values = driveline.values()
    model = driveline_matrices(driveline)
    static = StaticTorque(driveline, scenario.equilibrium)
    transfer_functions = {
        'P_1': ('C_m', 'w_d', engine_to_slip(driveline)),
        'P_2': ('C_f', 'w_d', clutch_to_slip(driveline)),
        'P_3': ('C_load', 'w_d', load_to_slip(driveline)),
        'G_a': ('C_request', 'C_actuator', scenario.actuator.transfer_function()),
    }
    return PlantOnPaper(
        scenario=scenario.name,
        parameters={
            symbol: ParameterEntry(name=name, value=float(values[name]), unit=unit)
            for name, (symbol, unit) in SYMBOLS_AND_UNITS.items()
        },
        state_space=StateSpaceEntry(
            states=STATES,
            inputs=INPUTS,
            outputs=OUTPUTS,
            A=_rows(model.a),
            B=_rows(model.b),
            C=_rows(model.c),
            D=_rows(model.d),
        ),
        transfer_functions={
            name: _function_entry(source, output, function)
            for name, (source, output, function) in transfer_functions.items()
        },
        actuator_delay_s=scenario.actuator.delay_s,
        c_fol={
            name: StaticFactor(factor=static.torque(*row), unit=unit)
            for (name, unit), row in zip(
                _STATIC_INPUTS.items(), np.eye(len(_STATIC_INPUTS)).tolist(), strict=True
            )
        },
    )


def _rows(matrix: np.ndarray) -> list[list[float]]:
    """Return the rows of a matrix, with 0 for -0."""
    rows: list[list[float]] = (matrix + 0.0).tolist()
    return rows


def _function_entry(source: str, output: str, function: FactoredTransferFunction) -> PlantFunction:
    return PlantFunction(
        input=source,
        output=output,
        function=function,
        num=(function.gain * _polynomial(function.numerator)).tolist(),
        den=_polynomial(function.denominator).tolist(),
    )


def _polynomial(factors: Sequence[Factor]) -> np.ndarray:
    each = [np.array([1.0, *f] if isinstance(f, tuple) else [1.0, f]) for f in factors]
    return reduce(np.polymul, each, np.ones(1))
