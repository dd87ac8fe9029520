# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Subcommand `thesis studies`: the causes of the predictive controllers' results."""

import argparse
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from ddct_bringup.reproduction.studies import (
    engagements,
    mpc4_readings,
    readings,
    scenario_changes,
    sweeps,
    table_5_2,
    wear,
)
from ddct_bringup.reproduction.studies.study import Study, StudyFunction, dash_reason
from ddct_controllers.design.drawing.chart_style import chart_style, save_figure
from ddct_plant.base.errors import DdctError, require_choice
from ddct_plant.files.json_records import write_json
from ddct_plant.files.output_file import STDOUT
from ddct_plant.program.command_line import complain
from ddct_plant.program.printed_table import print_note, print_table
from ddct_plant.program.table import with_reasons

_ABOUT: Mapping[StudyFunction, str] = {
    sweeps.engine_authority: 'MPC4 by how far it may move the engine torque',
    mpc4_readings.mpc4_readings: 'MPC4 by reading of Section 4.3',
    sweeps.pedal_positions: '`pedal_mpc` by pedal position',
    readings.readings: 'MPC1-3 by reading of Section 4.2 and Table 4.1',
    scenario_changes.scenario_changes: 'the predicted rows by change of the scenario',
    sweeps.state_of_art: 'controllers after works that the thesis cites, new and worn',
    table_5_2.table_5_2_in_numbers: 'Table 5.2: our figures, the words they come to, the print',
    mpc4_readings.torque_level: 'MPC4 by its pull towards the demand',
    sweeps.torsion_weight: '`mpc_torsion` by its weight (Section 6.1)',
    sweeps.two_input_wear: 'controllers of clutch and engine, worn',
    wear.wear: 'MPC3 and its descendants, Hinf2 and LS8 at every wear gain',
    wear.wear_estimate: 'how well `mpc_wear` estimates K_usura',
    wear.wear_feedforward: '`wear` in the architecture of Figure 5.1',
}
STUDIES: Mapping[str, StudyFunction] = engagements.ENGAGEMENTS | {
    function.__name__: function for function in _ABOUT
}
"""Functions of all studies by name."""
_DESCRIPTION = """\
Study the predictive controllers of Chapter 4, and of what it leaves to future work, in
the closed loop of the frozen thesis scenario. Then judge every controller in every
packaged scenario. Each study is a table, those of the scenarios with a chart."""
_OF_A_SCENARIO = 'every controller in this scenario, new and worn'
_EPILOG = """\
examples:
  ddct thesis studies                                every study
  ddct thesis studies --study readings               MPC1-3 under the readings of Table 4.1
  ddct thesis studies --study wear --json wear.json
  ddct thesis studies --study engagements_launch --charts ."""


def add_parser(subparsers: Any) -> None:
    """Add `studies` to the subcommands of `thesis`."""
    parser = subparsers.add_parser(
        'studies',
        description=_DESCRIPTION,
        epilog=f'{_studies()}\n\n{_EPILOG}',
    )
    parser.add_argument(
        '--study',
        action='append',
        metavar='NAME',
        help='only this study, one of those below; may be repeated',
    )
    parser.add_argument('--json', metavar='FILE', help='write the tables; - is standard output')
    parser.add_argument(
        '--charts',
        metavar='DIR',
        help='draw the charts of studies that have one: STUDY.png and .svg, their data in .csv',
    )
    parser.set_defaults(run=run)


def _studies() -> str:
    """Return every study with its subject, a line each."""
    width = max(map(len, STUDIES))
    return '\n'.join(['studies:', *(f'  {name:{width}}  {_about(name)}' for name in STUDIES)])


def _about(name: str) -> str:
    return _ABOUT.get(STUDIES[name], _OF_A_SCENARIO)


def run(options: argparse.Namespace) -> int:
    """Compute the tables, print or write them as requested, and return the exit code."""
    names = options.study or list(STUDIES)
    for name in names:
        require_choice('study', name, list(STUDIES))
    if options.charts and not Path(options.charts).is_dir():
        raise DdctError(f'--charts {options.charts}: there is no such folder: make it first')
    studies: dict[str, Study] = {}
    for name in names:
        complain('ddct thesis studies', name)
        studies[name] = STUDIES[name]()
        if options.json != STDOUT:
            _print(studies[name])
        draw = studies[name].draw
        if options.charts and draw:
            with chart_style():
                save_figure(draw(), Path(options.charts), name)
    if options.json:
        write_json(options.json, {name: study.document for name, study in studies.items()})
    return 0


def _print(study: Study) -> None:
    print_table(with_reasons(replace(study, complete='--json FILE'), dash_reason))
    for remark in study.remarks:
        print_note(remark)
    if study.remarks:
        print()
