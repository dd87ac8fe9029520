# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Subcommand `design plant`: the linear plant of a scenario on paper, and as a file for others."""

import argparse
import io
from pathlib import Path
from typing import Any

from ddct_controllers.workflows.plant_on_paper import INPUTS, STATES, PlantOnPaper, plant_on_paper
from ddct_controllers.workflows.plant_text import as_mat, as_matlab, factored_text
from ddct_plant.base.errors import ParameterError
from ddct_plant.files.json_records import write_json
from ddct_plant.files.output_file import require_place, write_bytes, write_text
from ddct_plant.program.command_line import show_and_write
from ddct_plant.program.printed_table import print_tables
from ddct_plant.program.table import TextTable
from ddct_plant.scenario.choices.command_line import add_scenario_options
from ddct_plant.scenario.chosen import scenario_of

_DESCRIPTION = """\
The linear plant of a scenario, with its numbers: parameters, A, B, C, D, the transfer functions
P_1, P_2, P_3 to slip speed and G_a of the actuator, its delay, and C_fOL. SI units; the clutch
slips, and no torque is limited. docs/thesis/plant.md explains the symbols and signs."""
_EXAMPLES = """\
examples:
  ddct design plant
  ddct design plant --export plant.m --export plant.mat
  ddct design plant --set vehicle.mass_kg=1800 --export plant.json"""
_FORMATS = ('.json', '.m', '.mat')


def add_parser(subparsers: Any) -> None:
    """Add `plant` to the subcommands of `design`."""
    parser = subparsers.add_parser(
        'plant',
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
    )
    add_scenario_options(parser, set_example='driveline.halfshaft_stiffness=8000')
    parser.add_argument(
        '--export',
        action='append',
        default=[],
        metavar='FILE',
        help=f'write it; the name ends in one of {", ".join(_FORMATS)}; may be repeated',
    )
    parser.add_argument('--json', metavar='FILE', help='write the JSON; - is standard output')
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the tables, write the files, and return the exit code."""
    for file in options.export:
        if Path(file).suffix not in _FORMATS:
            raise ParameterError(
                f'--export {file}: the name must end in one of {", ".join(_FORMATS)}'
            )
        require_place('--export', file)
    paper = plant_on_paper(scenario_of(options, options.overrides))
    show_and_write(options.json, paper, lambda: print_tables(paper_tables(paper).values()))
    for file in options.export:
        _export(file, paper)
    return 0


def _export(file: str, paper: PlantOnPaper) -> None:
    if file.endswith('.json'):
        write_json(file, paper)
    elif file.endswith('.m'):
        write_text(file, as_matlab(paper))
    else:
        # Only here: it takes half a second to load.
        from scipy.io import savemat

        content = io.BytesIO()
        savemat(content, as_mat(paper), oned_as='row')
        write_bytes(file, content.getvalue())


def paper_tables(paper: PlantOnPaper) -> dict[str, TextTable]:
    """Return the tables of a plant on paper by name."""
    space = paper.state_space
    columns = (*STATES, *INPUTS)
    dynamics = [
        [f'd{state}/dt', *(f'{number:.6g}' for number in (*a, *b))]
        for state, a, b in zip(STATES, space.A, space.B, strict=True)
    ]
    outputs = [
        [output, *(f'{number:.6g}' for number in (*c, *d))]
        for output, c, d in zip(space.outputs, space.C, space.D, strict=True)
    ]
    return {
        'parameters': TextTable(
            f'Parameters of the driveline, scenario {paper.scenario}',
            ('symbol', 'value', 'unit', 'scenario key'),
            [
                (symbol, f'{each.value:.8g}', each.unit, _key_of(each.name))
                for symbol, each in paper.parameters.items()
            ],
        ),
        'state_space': TextTable(
            'A and B: each row is the sum of its numbers times the column',
            ('', *columns),
            dynamics,
        ),
        'outputs': TextTable(
            'C and D: each row is the sum of its numbers times the column', ('', *columns), outputs
        ),
        'transfer_functions': TextTable(
            f'Transfer functions, s in rad/s; a delay of {paper.actuator_delay_s:g} s before G_a',
            ('', 'from', 'to', 'function'),
            [
                (name, each.input, each.output, factored_text(each.function))
                for name, each in paper.transfer_functions.items()
            ],
        ),
        'c_fol': TextTable(
            'C_fOL: the sum of each signal times its factor',
            ('signal', 'factor', 'unit of the factor'),
            [(name, f'{each.factor:.8g}', each.unit) for name, each in paper.c_fol.items()],
        ),
    }


def _key_of(name: str) -> str:
    """Return the scenario key that gives a parameter: `gear` gives the ratio."""
    return 'gear' if name == 'total_ratio' else f'driveline.{name}'
