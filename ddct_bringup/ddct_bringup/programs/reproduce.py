"""Program `reproduce`: the thesis's numbers, figures, studies and calibration, made again."""

from ddct_bringup.reproduction.calibration import command as calibration_command
from ddct_bringup.reproduction.figures import command as figures_command
from ddct_bringup.reproduction.numbers import command as numbers_command
from ddct_bringup.reproduction.studies import command as studies_command
from ddct_plant.graph.run_info import package_version
from ddct_plant.program.command_line import ProgramParser, run_program

PROGRAM = 'reproduce'
_COMMANDS = (numbers_command, figures_command, studies_command, calibration_command)

_EPILOG = """\
examples:
  reproduce numbers                     every printed number beside ours
  reproduce figures --out figures       the thesis's figures, drawn again
  reproduce studies                     what decides how the predictive controllers fare
  reproduce calibration --quick         the scenario, fitted to Table 5.1

Each of them has its own --help."""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _reproduce, argv)


def _reproduce(argv: list[str]) -> int:
    parser = ProgramParser(
        prog=PROGRAM,
        description='Compute what the thesis prints, and hold it against the print.',
        epilog=_EPILOG,
    )
    parser.add_argument('--version', action='version', version=package_version())
    commands = parser.add_subparsers(required=True, metavar='WHAT')
    for command in _COMMANDS:
        command.add_parser(commands)
    options = parser.parse_args(argv)
    return options.run(options)


if __name__ == '__main__':
    raise SystemExit(main())
