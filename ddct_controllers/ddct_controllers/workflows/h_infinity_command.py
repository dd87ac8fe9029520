# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Subcommand `design h-infinity`: Chapter 3 step by step, or a controller of one's own."""

import argparse
import sys
from typing import Any

from ddct_controllers.design.h_infinity.design import METHODS, design_h_infinity
from ddct_controllers.design.h_infinity.recipes import (
    RECIPES,
    THESIS_SPECIFICATIONS,
    make_weights,
)
from ddct_controllers.design.h_infinity.record import (
    design_record,
    shortfalls,
    uncertainty_record,
)
from ddct_controllers.design.h_infinity.record_types import HinfOrigin, HinfResult
from ddct_controllers.design.h_infinity.tables import design_tables
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_controllers.from_file.designed import DesignedController
from ddct_controllers.linear import BILINEAR, HOLD
from ddct_controllers.workflows.design_output import (
    OptionTable,
    add_design_options,
    chosen_plant,
    fraction_of,
    free_name,
    show,
    write_design,
)
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.json_records import to_json
from ddct_plant.program.command_line import complain, number_in

_DESCRIPTION = """\
Go through Chapter 3 of the thesis: from specifications to weights, then synthesis, cleaning and
discretisation, and what the closed loop does. --out writes the controller as DIR/NAME.yaml,
which `compare` takes, and charts. It is written only if its sampled loop meets the
specifications and is stable at every corner of the driveline, or with --write-anyway.
--weights thesis takes K and w_2 as printed. fitted takes those that lead to nearly the printed
Hinf1. sampled takes the printed ones and one on the torque, with hold and delay in the plant;
choose it for a controller that is to run, with specifications that it meets, as in the last
example: with the thesis's it rises in 0.49 s and overshoots by 22 %.
Without --rise-time and --overshoot the thesis's 0.3 s and 8 % hold. K grows with the square of
the rise time and w_2 falls with it, unless given. Another car than the thesis's: --car."""
_EXAMPLES = """\
examples:
  ddct design h-infinity
  ddct design h-infinity --weights fitted --method lmi
  ddct design h-infinity --car city7                        for another car, or mycar.yaml
  ddct design h-infinity --weights fitted --rise-time 0.5 --overshoot 15 --name mine --out designs
  ddct compare --controllers hinf1,hinf_sampled,designs/mine.yaml --headless --out runs/mine
  ddct design h-infinity --weights sampled --rise-time 0.7 --overshoot 26 \\
      --low-frequency-gain 0.15 --bandwidth 28 --name run_me --out designs"""

_OPTIONS: OptionTable = {
    '--weights': {'choices': tuple(RECIPES), 'default': 'thesis', 'help': '(default: thesis)'},
    '--low-frequency-gain': {'type': float, 'metavar': 'K', 'help': '|S| near 0 over w^2'},
    '--bandwidth': {
        'type': number_in('rad/s'),
        'metavar': 'W_2',
        'help': 'corner of W_t in rad/s',
    },
    '--effort': {
        'type': float,
        'metavar': 'TORQUE',
        'help': 'N m per rpm of torque that costs 1 (sampled)',
    },
    '--back-off': {
        'type': float,
        'metavar': 'FACTOR',
        'help': 'level over the optimum, a factor (riccati)',
    },
    '--method': {'choices': METHODS, 'default': METHODS[0], 'help': '(default: riccati)'},
    '--write-anyway': {'action': 'store_true', 'help': 'write a design that falls short too'},
}


def add_parser(subparsers: Any) -> None:
    """Add `h-infinity` to the subcommands of `design`."""
    parser = subparsers.add_parser(
        'h-infinity',
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
    )
    add_design_options(parser, _OPTIONS)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the tables, write the files, and return the exit code."""
    name = free_name(options)
    specifications = TimeSpecifications(
        THESIS_SPECIFICATIONS.rise_time_s if options.rise_time is None else options.rise_time,
        THESIS_SPECIFICATIONS.overshoot
        if options.overshoot is None
        else fraction_of(options.overshoot),
    )
    weights = make_weights(
        options.weights,
        specifications,
        options.low_frequency_gain,
        options.bandwidth,
        options.effort,
        options.back_off,
    )
    if options.method == 'lmi' and options.back_off is not None:
        raise ParameterError('--back-off is for --method riccati: the LMIs give their optimum')
    scenario, title = chosen_plant(options)
    design = design_h_infinity(weights, scenario.driveline, options.method, scenario.actuator)
    uncertainty = uncertainty_record(scenario.driveline)
    record = design_record(name, options.weights, specifications, design, title)
    missing = shortfalls(record)
    tables = design_tables([record], uncertainty)
    show(options, tables.values(), HinfResult(record, uncertainty, missing))
    if missing:
        _report_shortfall(options, name, '; '.join(missing))
    origin = to_json(HinfOrigin(record.provenance, missing))
    discretisation = BILINEAR if weights.sampled else HOLD
    designed = DesignedController(name, design.cleaned, origin, discretisation)
    write_design(options, designed, specifications, scenario)
    return 0


def _report_shortfall(options: argparse.Namespace, name: str, missing: str) -> None:
    """Print how a design falls short; raise DdctError if the user requested that design."""
    requested = (options.rise_time, options.overshoot, options.out)
    if any(each is not None for each in requested) and not options.write_anyway:
        raise DdctError(
            f'{name} falls short: {missing}: ask for less, choose other weights, or add '
            '--write-anyway'
        )
    end = '' if options.out else '; nothing is written'
    sys.stdout.flush()  # the tables come first, also in a pipe
    complain('ddct design', f'{name}: {missing}{end}')
