# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Subcommand `design loop-shaping`: Chapter 2 step by step, or a controller of one's own."""

import argparse
import sys
from typing import Any

from ddct_controllers.design.analysis.loops import plant_in_rpm
from ddct_controllers.design.loop_shaping.design import required_integrators
from ddct_controllers.design.loop_shaping.record import (
    design_record,
    thesis_record,
)
from ddct_controllers.design.loop_shaping.search import STRUCTURES, design_loop_shaping
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_controllers.design.loop_shaping.tables import design_tables, thesis_tables
from ddct_controllers.from_file.designed import DesignedController
from ddct_controllers.workflows.design_output import (
    OptionTable,
    add_design_options,
    chosen_plant,
    fraction_of,
    free_name,
    show,
    write_design,
)
from ddct_plant.base.errors import ParameterError
from ddct_plant.files.json_records import to_json
from ddct_plant.models.driveline_model import engine_to_slip

_DESCRIPTION = """\
With --rise-time and --overshoot: find a controller that meets them in the sampled loop. --out
writes it as DIR/NAME.yaml, which `compare` takes as a controller, with its
Nyquist, Nichols and step charts. Without them: go through Chapter 2 of the thesis. This shows
its specifications translated, the steps from K_c/s to G_c1, G_c2 beside a rule for it, and both
loops as the thesis judges them, with the delay, and sampled with hold and delay.
`ddct thesis numbers` has every number."""
_EXAMPLES = """\
examples:
  ddct design loop-shaping
  ddct design loop-shaping --rise-time 0.6 --overshoot 14
  ddct design loop-shaping --rise-time 0.3 --overshoot 10 --name quick --out designs
  ddct design loop-shaping --rise-time 0.6 --overshoot 14 --car city7    for another car
  ddct compare --controllers ls8,designs/quick.yaml --headless --out runs/quick"""
_DISTURBANCES = {'none': None, 'step': 0, 'ramp': 1}
"""Order h_p of the engine torque that must leave no error; without one G_c has no integrator."""
_OPTIONS: OptionTable = {
    '--disturbance': {
        'choices': _DISTURBANCES,
        'help': 'engine torque after which no error is left (default: step)',
    },
    '--structure': {'choices': STRUCTURES, 'help': 'as G_c1 or as G_c2 (default: either)'},
}
_NEEDS_SPECIFICATIONS = (
    *('disturbance', 'structure', 'name', 'out', 'overwrite'),
    *('scenario', 'car', 'drive', 'set'),
)
"""Options that the workflow of Chapter 2 does not have: it is for the thesis's car."""


def add_parser(subparsers: Any) -> None:
    """Add `loop-shaping` to the subcommands of `design`."""
    parser = subparsers.add_parser(
        'loop-shaping',
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
    )
    add_design_options(parser, _OPTIONS)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the tables, write the files, and return the exit code."""
    if options.rise_time is None and options.overshoot is None:
        _show_thesis(options)
    else:
        _design_controller(options)
    return 0


def _show_thesis(options: argparse.Namespace) -> None:
    given = vars(options) | {'set': options.overrides or None}
    for name in _NEEDS_SPECIFICATIONS:
        if given[name] is not None:
            raise ParameterError(f'--{name} needs specifications: add --rise-time and --overshoot')
    record = thesis_record()
    show(options, thesis_tables(record).values(), record)


def _design_controller(options: argparse.Namespace) -> None:
    if options.rise_time is None or options.overshoot is None:
        missing = '--rise-time' if options.rise_time is None else '--overshoot'
        raise ParameterError(
            f'{missing} is missing: a design needs --rise-time and --overshoot', key=missing
        )
    specifications = TimeSpecifications(options.rise_time, fraction_of(options.overshoot))
    name = free_name(options)
    scenario, title = chosen_plant(options)
    driveline = scenario.driveline
    order = _DISTURBANCES[options.disturbance or 'step']
    integrators = 0
    if order is not None:
        disturbance_path = engine_to_slip(driveline)
        integrators = required_integrators(plant_in_rpm(driveline), disturbance_path, order)
    print('ddct design loop-shaping: searching', file=sys.stderr, flush=True)
    structures = (options.structure,) if options.structure else STRUCTURES
    design = design_loop_shaping(
        specifications, integrators, driveline, structures, scenario.actuator
    )
    record = design_record(name, design, title)
    designed = DesignedController(name, design.controller, to_json(record.provenance))
    show(options, design_tables(record), record)
    write_design(options, designed, specifications, scenario)
