"""Program `design`: the thesis's design workflows, and what its numbers come to."""

from ddct_controllers.design import figures_command, margins_command, mpc_command, thesis_command
from ddct_controllers.design.h_infinity import command as hinf_command
from ddct_controllers.design.loop_shaping import command as loop_shaping_command
from ddct_plant.cli import ProgramParser, run_program
from ddct_plant.graph.run_info import package_version

PROGRAM = 'design'
_COMMANDS = (
    loop_shaping_command,
    hinf_command,
    mpc_command,
    margins_command,
    thesis_command,
    figures_command,
)

_EPILOG = """\
examples:
  design loop-shaping                                 Chapter 2, step by step
  design loop-shaping --rise-time 0.6 --overshoot 14 --name mine --out designs
  design h-infinity                                   Chapter 3, step by step
  design mpc                                          Chapter 4: studies of the MPCs
  design margins --controller all                     the sampled loop with hold and delay
  design thesis                                       every printed number beside ours
  design figures --out figures                        the thesis's figures, drawn again

Each workflow has its own --help.
"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _design, argv)


def _design(argv: list[str]) -> int:
    parser = ProgramParser(
        prog=PROGRAM,
        description='Design controllers, and check them against the thesis.',
        epilog=_EPILOG,
    )
    parser.add_argument('--version', action='version', version=package_version())
    commands = parser.add_subparsers(required=True, metavar='WORKFLOW')
    for command in _COMMANDS:
        command.add_parser(commands)
    options = parser.parse_args(argv)
    return options.run(options)


if __name__ == '__main__':
    raise SystemExit(main())
