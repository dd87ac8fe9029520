"""Option `design mpc --export DIR`: a predictive controller as C for a control unit."""

import argparse
from pathlib import Path

from ddct_controllers.mpc.export.export_controller import export_controller
from ddct_controllers.registry import make_controller
from ddct_plant.errors import ParameterError
from ddct_plant.run_settings import ARCHITECTURES, RunSettings
from ddct_plant.scenario_file import load_scenario
from ddct_plant.scenario_options import add_scenario_options


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add --export and what says which controller it writes."""
    group = parser.add_argument_group('export to C (docs/control_unit.md)')
    group.add_argument('--export', type=Path, metavar='DIR', help='write C in place of studies')
    group.add_argument('--controller', metavar='NAME', help='(default: mpc3)')
    # Without defaults, so that one given without --export is noticed.
    add_scenario_options(group, default=None, set_example='controllers.mpc3.torque_rate_n_m_s=500')
    group.add_argument('--architecture', choices=ARCHITECTURES, help='(default: detailed)')
    group.add_argument('--overwrite', action='store_true', help='replace an earlier export')


def require_no_export_options(options: argparse.Namespace) -> None:
    """Raise ParameterError for an option that says what to export while nothing is exported."""
    for name in ('controller', 'scenario', 'overrides', 'architecture', 'overwrite'):
        if getattr(options, name):
            option = 'set' if name == 'overrides' else name
            raise ParameterError(f'--{option} says what to export: add --export DIR')


def run_export(options: argparse.Namespace) -> int:
    """Write the C, print the names of its files, and return the exit code."""
    if options.study or options.json or options.write_doc:
        raise ParameterError('--export writes no studies: leave out --study, --json, --write-doc')
    settings = RunSettings(
        load_scenario(options.scenario or 'thesis', options.overrides),
        architecture=options.architecture or 'detailed',
    )
    name = options.controller or 'mpc3'
    controller = make_controller(name, settings)
    for path in export_controller(
        controller, name, settings, options.export, overwrite=options.overwrite
    ):
        print(path)
    return 0
