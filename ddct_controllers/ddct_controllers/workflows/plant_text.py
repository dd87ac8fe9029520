# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The linear plant on paper as text for a reader, as a script for MATLAB and as a .mat file."""

from collections.abc import Iterable, Sequence

import numpy as np

from ddct_controllers.design.state_space import factors_text
from ddct_controllers.workflows.plant_on_paper import MATRICES, PlantOnPaper
from ddct_plant.linear.lti import FactoredTransferFunction


def factored_text(function: FactoredTransferFunction) -> str:
    """Return a transfer function as the thesis prints it: gain (s + a) (s^2 + b s + c) / [...]."""
    above, below = (
        factors_text(side, digits=6) for side in (function.numerator, function.denominator)
    )
    return f'{function.gain:.6g} {above}'.rstrip() + f' / [{below}]'


def as_matlab(paper: PlantOnPaper) -> str:
    """Return a script for MATLAB or Octave that builds the systems under their names."""
    space = paper.state_space
    signals = (
        ('State', space.states),
        ('Input', space.inputs),
        ('Output', space.outputs),
    )
    names = (f"'{kind}Name', {_cell(symbols)}" for kind, symbols in signals)
    factors = [each.factor for each in paper.c_fol.values()]
    lines = [
        f'% The linear plant of scenario {paper.scenario}: SI units, torques in N m.',
        *(
            f'{symbol} = {each.value!r};  % {each.unit}, {each.name}'
            for symbol, each in paper.parameters.items()
        ),
        *(f'{name} = [{"; ".join(map(_row, getattr(space, name)))}];' for name in MATRICES),
        f'driveline = ss(A, B, C, D, {", ".join(names)});',
        *(
            f'{name} = tf([{_row(each.num)}], [{_row(each.den)}]);  % {each.output} / {each.input}'
            for name, each in paper.transfer_functions.items()
        ),
        f'actuator_delay_s = {paper.actuator_delay_s!r};',
        f'c_fol = [{_row(factors)}];  % times [{"; ".join(paper.c_fol)}]',
    ]
    return '\n'.join(lines) + '\n'


def _row(numbers: Sequence[float]) -> str:
    return ' '.join(map(repr, numbers))


def _cell(names: Iterable[str]) -> str:
    return '{' + ', '.join(f"'{name}'" for name in names) + '}'


def as_mat(paper: PlantOnPaper) -> dict[str, object]:
    """Return the variables of a .mat file: matrices, parameters, num and den of each function."""
    space = paper.state_space
    functions = paper.transfer_functions.items()
    return {
        **{symbol: each.value for symbol, each in paper.parameters.items()},
        **{name: np.array(getattr(space, name)) for name in MATRICES},
        **{name: {'num': each.num, 'den': each.den} for name, each in functions},
        'actuator_delay_s': paper.actuator_delay_s,
        'c_fol': [each.factor for each in paper.c_fol.values()],
    }
