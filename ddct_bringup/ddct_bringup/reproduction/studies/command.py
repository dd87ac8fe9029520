"""Subcommand `reproduce studies`: what decides how the predictive controllers fare."""

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ddct_bringup.reproduction.studies import (
    admissible_scenarios,
    clutch_torque_limit,
    engagements,
    mpc4_readings,
    readings,
    sweeps,
    table_5_2,
    wear,
)
from ddct_bringup.reproduction.studies.study import Study, StudyFunction
from ddct_controllers.design.drawing.chart_style import chart_style, save_figure
from ddct_plant.base.errors import DdctError, require_choice
from ddct_plant.files.output_file import STDOUT, write_json
from ddct_plant.program.command_line import complain
from ddct_plant.program.table import print_table

STUDIES: Mapping[str, StudyFunction] = engagements.ENGAGEMENTS | {
    function.__name__: function
    for function in (
        admissible_scenarios.admissible_scenarios,
        clutch_torque_limit.clutch_torque_limit,
        sweeps.engine_authority,
        mpc4_readings.mpc4_readings,
        sweeps.pedal_positions,
        admissible_scenarios.prediction_ranges,
        readings.readings,
        admissible_scenarios.score_windows,
        sweeps.state_of_art,
        table_5_2.table_5_2_in_numbers,
        mpc4_readings.torque_level,
        sweeps.torsion_weight,
        sweeps.two_input_wear,
        wear.wear,
        wear.wear_estimate,
        wear.wear_feedforward,
        admissible_scenarios.worn_ranges,
    )
}
"""Every study by its name."""
_DESCRIPTION = """\
Study the predictive controllers of Chapter 4, and of what it leaves to future work, in
the closed loop of the frozen thesis scenario. Then judge every controller in every
packaged scenario. Each study is a table, those of the scenarios with a chart."""
_EPILOG = """\
examples:
  ddct reproduce studies                                every study
  ddct reproduce studies --study readings               MPC1-3 under the readings of Table 4.1
  ddct reproduce studies --study wear --json wear.json
  ddct reproduce studies --study engagements_launch --charts ."""


def add_parser(subparsers: Any) -> None:
    """Add `studies` to the subcommands of `reproduce`."""
    parser = subparsers.add_parser(
        'studies',
        help='studies of the predictive controllers',
        description=_DESCRIPTION,
        epilog=_EPILOG,
    )
    parser.add_argument(
        '--study', action='append', metavar='NAME', help='only this study; may be repeated'
    )
    parser.add_argument('--json', metavar='FILE', help='write the tables; - is standard output')
    parser.add_argument(
        '--charts',
        metavar='DIR',
        help='draw the charts of studies that have one: STUDY.png and .svg, their data in .csv',
    )
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Make the tables, print them or write them where asked for, and return the exit code."""
    names = options.study or list(STUDIES)
    for name in names:
        require_choice('study', name, list(STUDIES))
    if options.charts and not Path(options.charts).is_dir():
        raise DdctError(f'--charts {options.charts}: there is no such folder: make it first')
    studies: dict[str, Study] = {}
    for name in names:
        complain('ddct reproduce studies', name)
        studies[name] = STUDIES[name]()
        if options.json != STDOUT:
            _print(studies[name])
        draw = studies[name].draw
        if options.charts and draw:
            with chart_style():
                save_figure(draw(), Path(options.charts), name)
    if options.json:
        write_json(options.json, {name: study.as_dict() for name, study in studies.items()})
    return 0


def _print(study: Study) -> None:
    print_table(study)
    for remark in study.remarks:
        print(f'  {remark}')
    if study.remarks:
        print()
