# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Subcommand `design margins`: the robustness of linear controllers in the loop as it runs."""

import argparse
from functools import partial
from typing import Any

from ddct_controllers.design.analysis.loop_quantities import LOOP_QUANTITY_OF
from ddct_controllers.registry import (
    controller_label,
    require_known_controllers,
    working_controllers,
)
from ddct_controllers.workflows.evidence import frequency_evidence
from ddct_controllers.workflows.evidence_types import (
    FrequencyEvidence,
    LinearEntry,
    linear_entries,
)
from ddct_plant.base.errors import DdctError
from ddct_plant.program.command_line import complain, show_and_write
from ddct_plant.program.table import Table, print_table, text_or_dash
from ddct_plant.scenario.differences import changed_values, scenario_title
from ddct_plant.scenario.options import add_scenario_options, scenario_of
from ddct_plant.scenario.settings import RunSettings

_DESCRIPTION = """\
Compute the margins of the sampled loop: the hold, the actuator with its delay, and the driveline,
both of the scenario. At one wear gain: gain, phase, delay and disk margins, M_s, M_t, crossover,
bandwidth, and the driveline mode. Then the highest wear gain that is stable. Over wear gains 0.7
to 1.3 and all driveline parameters +-20 %: the highest M_s and the number of unstable corners."""
_EXAMPLES = """\
examples:
  ddct design margins
  ddct design margins --controller ls8 --wear-gain 1.3 --json -
  ddct design margins --controller hinf2 --set actuator.delay_s=0.05"""


def add_parser(subparsers: Any) -> None:
    """Add `margins` to the subcommands of `design`."""
    parser = subparsers.add_parser(
        'margins',
        help='margins of the sampled loop, over wear and plant corners',
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
    )
    parser.add_argument('--controller', default='all', metavar='NAME|FILE|all')
    parser.add_argument(
        '--wear-gain', type=float, default=1.0, metavar='X', help='K_usura, 1 if new'
    )
    add_scenario_options(parser, set_example='driveline.halfshaft_stiffness=8000')
    parser.add_argument('--json', metavar='FILE', help='write all results; - is standard output')
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the table, write the JSON, and return the exit code."""
    settings = RunSettings(scenario_of(options, options.overrides), wear_gain=options.wear_gain)
    every = options.controller == 'all'
    labels = [] if every else [controller_label(options.controller)]
    require_known_controllers(settings.scenario, labels)
    report = partial(complain, 'ddct design')
    names = working_controllers(settings, report) if every else [options.controller]
    evidence = frequency_evidence(names, settings, report if every else None)
    if not linear_entries(evidence):
        raise DdctError(
            f'{options.controller} is not linear: it has no frequency response; '
            'choose a controller that has a linear_model, or all'
        )
    show_and_write(options.json, evidence, lambda: _show(evidence, settings))
    return 0


def _show(evidence: FrequencyEvidence, settings: RunSettings) -> None:
    print_table(margins_table(evidence, settings))
    others = [each['controller'] for each in evidence['controllers'] if each['linear'] is False]
    if others:
        print(f'Not linear, without a frequency response: {", ".join(others)}')


def margins_table(evidence: FrequencyEvidence, settings: RunSettings) -> Table:
    """Return a row of quantities for each linear controller of `frequency_evidence`."""
    scenario = settings.scenario
    changed = scenario_title(scenario.name, changed_values(scenario))
    headers = (
        *('controller', 'stable'),
        *(quantity.heading for quantity in LOOP_QUANTITY_OF.values()),
        *('wear below', 'corner M_s', f'unstable of {evidence["conditions"]["corners"]}'),
    )
    rows = [_row(entry, settings.wear_gain) for entry in linear_entries(evidence)]
    return Table(f'Sampled loop, wear gain {settings.wear_gain:g}, {changed}', headers, rows)


def _row(entry: LinearEntry, wear_gain: float) -> list[str]:
    point = next(point for point in entry['wear'] if point['wear_gain'] == wear_gain)
    interval = entry['stable_wear_gain']
    return [
        entry['controller'],
        'yes' if point['stable'] else 'no',
        *(quantity.cell(point) for quantity in LOOP_QUANTITY_OF.values()),
        text_or_dash(interval and interval['highest'], '.2f'),
        LOOP_QUANTITY_OF['sensitivity_peak'].cell(entry['corners']),
        str(entry['corners']['unstable']),
    ]
