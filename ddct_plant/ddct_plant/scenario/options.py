"""Options of programs that say which scenario is meant, and what in it is changed."""

import argparse

from ddct_plant.scenario.file import scenario_names

SET_EXAMPLE = 'load.slope_rad=0.05'


def add_scenario_options(
    parser: argparse.ArgumentParser, *, set_example: str = SET_EXAMPLE
) -> None:
    """Add --scenario, and --set as `overrides`; `load_scenario` takes both."""
    parser.add_argument(
        '--scenario',
        default='thesis',
        metavar='NAME|FILE',
        help=f'one of {", ".join(scenario_names())}, or a YAML file; default: %(default)s',
    )
    parser.add_argument(
        '--set',
        action='append',
        default=[],
        metavar='KEY=VALUE',
        dest='overrides',
        help=f'change a scenario key, such as {set_example}; may be repeated',
    )
