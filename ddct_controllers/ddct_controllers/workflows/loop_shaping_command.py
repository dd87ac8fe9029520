"""Subcommand `design loop-shaping`: Chapter 2 step by step, or a controller of one's own."""

import argparse
import sys
from pathlib import Path
from typing import Any

from ddct_controllers.design.analysis.loops import plant_in_rpm
from ddct_controllers.design.analysis.steady_state import required_integrators
from ddct_controllers.design.loop_shaping.report import (
    Record,
    design_record,
    provenance,
    thesis_record,
)
from ddct_controllers.design.loop_shaping.search import STRUCTURES, design_loop_shaping
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_controllers.design.loop_shaping.tables import design_tables, thesis_tables
from ddct_controllers.designed import DesignedController
from ddct_controllers.workflows.design_output import require_free, write_design
from ddct_plant.base.errors import ParameterError
from ddct_plant.files.output_file import STDOUT, write_json, write_text
from ddct_plant.models.driveline_model import engine_to_slip
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.program.page_tables import fill_tables, read_page
from ddct_plant.program.table import print_table

_DESCRIPTION = """\
Without specifications, the thesis's Chapter 2: its specifications translated, the way from
K_c/s to G_c1, G_c2 beside a rule for it, and both in the loop as the thesis judges it, with
the delay, and sampled with hold and delay (`reproduce numbers` has every number).
With --rise-time and --overshoot, a controller that meets them in the sampled loop. --out
writes it as DIR/NAME.yaml, which `bringup` and `compare` take as a controller, with its
Nyquist, Nichols and step charts."""
_EXAMPLES = """\
examples:
  design loop-shaping
  design loop-shaping --rise-time 0.6 --overshoot 14
  design loop-shaping --rise-time 0.3 --overshoot 10 --name quick --out designs
  compare --controllers ls8,designs/quick.yaml --headless --out runs/quick"""
_DISTURBANCES = {'none': None, 'step': 0, 'ramp': 1}
"""h_p of the engine torque that must leave no error; without one G_c gets no integrator."""
_NEEDS_SPECIFICATIONS = ('disturbance', 'structure', 'name', 'out', 'overwrite')


def add_parser(subparsers: Any) -> None:
    """Add `loop-shaping` to the subcommands of `design`."""
    parser = subparsers.add_parser(
        'loop-shaping',
        help='Chapter 2 step by step, or a controller from your specifications',
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
    )
    parser.add_argument('--rise-time', type=float, metavar='S', help='longest t_r')
    parser.add_argument('--overshoot', type=float, metavar='PERCENT', help='largest overshoot')
    parser.add_argument(
        '--disturbance',
        choices=_DISTURBANCES,
        help='engine torque that leaves no error at last (default: step)',
    )
    parser.add_argument(
        '--structure', choices=STRUCTURES, help='as G_c1 or as G_c2 (default: either)'
    )
    parser.add_argument('--name', metavar='NAME', help='of the controller (default: mine)')
    parser.add_argument(
        '--out', type=Path, metavar='DIR', help='write the controller and its charts'
    )
    parser.add_argument(
        '--overwrite', action='store_true', default=None, help='replace an earlier design'
    )
    parser.add_argument('--json', metavar='FILE', help='write all figures; - is standard output')
    parser.add_argument('--write-doc', metavar='FILE', help='fill in the tables of the page FILE')
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the tables, write the files, and return the exit code."""
    if options.rise_time is None and options.overshoot is None:
        record = _thesis(options)
    else:
        record = _design(options)
    if options.json:
        write_json(options.json, record)
    return 0


def _thesis(options: argparse.Namespace) -> Record:
    for name in _NEEDS_SPECIFICATIONS:
        if getattr(options, name) is not None:
            raise ParameterError(f'--{name} needs specifications: add --rise-time and --overshoot')
    page = read_page(options.write_doc) if options.write_doc else ''
    record = thesis_record()
    tables = thesis_tables(record)
    if options.json != STDOUT:
        for table in tables.values():
            print_table(table)
    if options.write_doc:
        write_text(options.write_doc, fill_tables(page, 'loop-shaping', tables))
    return record


def _design(options: argparse.Namespace) -> Record:
    if options.rise_time is None or options.overshoot is None:
        missing = '--rise-time' if options.rise_time is None else '--overshoot'
        raise ParameterError(f'{missing} is missing: a design needs --rise-time and --overshoot')
    if options.write_doc:
        raise ParameterError('--write-doc is for the thesis: leave out the specifications')
    specifications = TimeSpecifications(options.rise_time, options.overshoot / 100.0)
    name = 'mine' if options.name is None else options.name
    require_free(name, options.out, overwrite=bool(options.overwrite))
    parameters = DrivelineParameters()
    print('design loop-shaping: searching', file=sys.stderr, flush=True)
    design = design_loop_shaping(
        specifications,
        _integrators(options.disturbance or 'step', parameters),
        parameters,
        (options.structure,) if options.structure else STRUCTURES,
    )
    record = design_record(name, design)
    designed = DesignedController(name, design.controller, provenance(design))
    if options.json != STDOUT:
        for table in design_tables(record):
            print_table(table)
    if options.out:
        path = write_design(options.out, designed, specifications, parameters)
        if options.json != STDOUT:
            print(f'Run it: bringup --controller {path} --out runs/{name}')
    return record


def _integrators(disturbance: str, parameters: DrivelineParameters) -> int:
    order = _DISTURBANCES[disturbance]
    if order is None:
        return 0
    return required_integrators(plant_in_rpm(parameters), engine_to_slip(parameters), order)
