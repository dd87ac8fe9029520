# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `design`: a controller from specifications, and margins for any car."""

from ddct_controllers import workflows
from ddct_plant.program.command_line import LateSubcommand, ProgramParser, run_subcommands

PROGRAM = 'ddct design'
_COMMANDS = {
    'loop-shaping': LateSubcommand(
        'Chapter 2 step by step, or a controller from your specifications',
        lambda: workflows.loop_shaping_command,
    ),
    'h-infinity': LateSubcommand(
        'Chapter 3 step by step, or a controller from your specifications',
        lambda: workflows.h_infinity_command,
    ),
    'mpc': LateSubcommand(
        'a predictive controller as C for a control unit', lambda: workflows.mpc_command
    ),
    'margins': LateSubcommand(
        'margins of the sampled loop, over wear and plant corners',
        lambda: workflows.margins_command,
    ),
    'plant': LateSubcommand(
        'the linear plant with its numbers, for JSON and MATLAB', lambda: workflows.plant_command
    ),
}

_DESCRIPTION = 'Design controllers, and check them in the loop as it runs.'
_EPILOG = """\
examples:
  ddct design loop-shaping                                 Chapter 2, step by step
  ddct design loop-shaping --rise-time 0.6 --overshoot 14 --name mine --out designs
  ddct design h-infinity                                   Chapter 3, step by step
  ddct design mpc --export control_unit --controller mpc3  C for a control unit
  ddct design margins --controllers all                    the sampled loop with hold and delay
  ddct design plant --export plant.m                       the plant's equations and numbers

Each workflow has its own --help. The thesis's numbers, figures and studies: ddct thesis."""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    parser = ProgramParser(prog=PROGRAM, description=_DESCRIPTION, epilog=_EPILOG)
    return run_subcommands(parser, _COMMANDS, argv, metavar='WORKFLOW')


if __name__ == '__main__':
    raise SystemExit(main())
