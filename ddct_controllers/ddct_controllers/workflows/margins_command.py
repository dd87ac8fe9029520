# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Subcommand `design margins`: the robustness of linear controllers in the loop as it runs."""

import argparse
from collections.abc import Sequence
from functools import partial
from typing import Any

from ddct_controllers.design.analysis.loop_quantities import LOOP_QUANTITY_OF
from ddct_controllers.registry import (
    controller_label,
    controllers_of,
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
from ddct_plant.files.json_records import to_json
from ddct_plant.program.command_line import complain, show_and_write
from ddct_plant.program.printed_table import print_note, print_table
from ddct_plant.program.table import TextTable, Weight, text_or_dash, with_reasons
from ddct_plant.scenario.choices.command_line import add_scenario_options
from ddct_plant.scenario.chosen import scenario_of
from ddct_plant.scenario.differences import changed_values, scenario_title
from ddct_plant.scenario.settings import CaseSettings, LinearSettings, RunSettings

_UNDEFINED = {
    'w_c': '|L| is below 1 at every frequency',
    'w_b': '|T| is above 0.71 at every frequency',
    **dict.fromkeys(('mode', 'damping', 'w_sr'), 'no pole pair is near the zeros of P_2'),
}
"""Reasons of dashes by symbol."""
_BY_QUANTITY = {
    **dict.fromkeys(('phase_margin_deg', 'delay_margin_s', 'sensitivity_peak'), Weight.NEEDED),
    **dict.fromkeys(('gain_margin_db', 'disk_margin', 'crossover_rad_s'), Weight.USEFUL),
}
"""Weight in the table of each quantity; those of the others are DETAIL."""
_WEIGHTS = (
    *(Weight.IDENTIFYING, Weight.NEEDED),
    *(_BY_QUANTITY.get(key, Weight.DETAIL) for key in LOOP_QUANTITY_OF),
    *(Weight.NEEDED, Weight.USEFUL, Weight.NEEDED),
)
_DESCRIPTION = """\
Compute the margins of the sampled loop: the hold, the actuator with its delay, and the driveline,
both of the scenario. At one wear gain: gain, phase, delay and disk margins, M_s, M_t, crossover,
bandwidth, and the driveline mode. Then the highest wear gain that is stable. Over wear gains 0.7
to 1.3 and all driveline parameters +-20 %: the highest M_s and the number of unstable corners."""
_EXAMPLES = """\
examples:
  ddct design margins
  ddct design margins --controllers ls8,hinf2 --wear-gain 1.3 --json -
  ddct design margins --controllers ls8 --car city7          in another car, or mycar.yaml
  ddct design margins --controllers hinf2 --set actuator.delay_s=0.05"""


def add_parser(subparsers: Any) -> None:
    """Add `margins` to the subcommands of `design`."""
    parser = subparsers.add_parser(
        'margins',
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
    )
    parser.add_argument(
        '--controllers',
        default='all',
        metavar='A,B,...|all',
        help='names or files (default: all)',
    )
    parser.add_argument(
        '--wear-gain', type=float, default=1.0, metavar='X', help='K_usura, 1 if new'
    )
    add_scenario_options(parser, set_example='driveline.halfshaft_stiffness=8000')
    parser.add_argument('--json', metavar='FILE', help='write all results; - is standard output')
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the table, write the JSON, and return the exit code."""
    known = LinearSettings(scenario_of(options, options.overrides))
    settings = RunSettings(known, CaseSettings(wear_gain=options.wear_gain))
    every = options.controllers == 'all'
    chosen = [] if every else controllers_of(options.controllers)
    labels = [controller_label(each) for each in chosen]
    require_known_controllers(settings.scenario, labels)
    report = partial(complain, 'ddct design')
    names = working_controllers(settings.known, report) if every else chosen
    evidence = frequency_evidence(names, settings, report if every else None)
    if not linear_entries(evidence):
        raise DdctError(
            f'{options.controllers} is not linear: it has no frequency response; '
            'choose a controller that has a linear_model, or all'
        )
    show_and_write(options.json, evidence, lambda: _show(evidence, settings))
    return 0


def _show(evidence: FrequencyEvidence, settings: RunSettings) -> None:
    print_table(margins_table(evidence, settings))
    others = [each.controller for each in evidence.controllers if each.linear is False]
    if others:
        print_note(f'Not linear, without a frequency response: {", ".join(others)}')


def margins_table(evidence: FrequencyEvidence, settings: RunSettings) -> TextTable:
    """Return a row of quantities for each linear controller of `frequency_evidence`."""
    scenario = settings.scenario
    changed = scenario_title(scenario.name, changed_values(scenario))
    headers = (
        *('controller', 'stable'),
        *(quantity.heading for quantity in LOOP_QUANTITY_OF.values()),
        *('wear below', 'corner M_s', f'unstable of {evidence.conditions.corners}'),
    )
    rows = [_row(entry, settings.case.wear_gain) for entry in linear_entries(evidence)]
    title = f'Sampled loop, wear gain {settings.case.wear_gain:g}, {changed}'
    table = TextTable(
        title, headers, rows, numbers=(False, False), weights=_WEIGHTS, complete='--json FILE'
    )
    return with_reasons(table, _dash_reason)


def _dash_reason(header: str, row: Sequence[str]) -> str:
    """Return the reason of a dash, from its column and its row."""
    if header == 'wear below':
        return 'stable at no wear gain, or at the highest that is tried'
    if header == 'corner M_s':
        return 'a corner is unstable'
    if row[1] == 'no':
        return 'the loop is not stable'
    kind = header.split()[0]
    return _UNDEFINED.get(kind, 'no change of this kind makes it unstable')


def _row(entry: LinearEntry, wear_gain: float) -> list[str]:
    point = next(point for point in entry.wear if point.wear_gain == wear_gain)
    interval, values = entry.stable_wear_gain, to_json(point)
    return [
        entry.controller,
        'yes' if point.margins.stable else 'no',
        *(quantity.cell(values) for quantity in LOOP_QUANTITY_OF.values()),
        text_or_dash(interval and interval.highest, '.2f'),
        LOOP_QUANTITY_OF['sensitivity_peak'].cell(to_json(entry.corners)),
        str(entry.corners.unstable_corners),
    ]
