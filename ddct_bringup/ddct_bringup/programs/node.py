# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `node`: start one node of the graph by its name, as `ros2 run` does."""

from collections.abc import Mapping
from importlib.metadata import EntryPoint
from typing import NoReturn

from ddct_bringup.programs.starting import lines_of, start
from ddct_plant.base.options import close_name
from ddct_plant.program.command_line import ProgramParser, run_program, scripts

PROGRAM = 'ddct node'
_EXAMPLES = """\
examples:
  ddct node driveline
  ddct node controller --ros-args -p controller:=ls8
  ddct node controller --help
"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return the exit code of the node that it starts."""
    return run_program(PROGRAM, _node, argv)


def node_names() -> dict[str, EntryPoint]:
    """Return the nodes of the graph by name: what `ros2 run` starts and is no program."""
    known = scripts()
    return {name: known[name] for name in sorted(known) if known[name].module.endswith('_node')}


def _node(argv: list[str]) -> int:
    known = node_names()
    if not argv or argv[0] not in known:
        _refuse(argv, known)
    return start(known[argv[0]], argv[1:])


def _refuse(argv: list[str], known: Mapping[str, EntryPoint]) -> NoReturn:
    """End the program after its --help, or with a line that says what is wrong."""
    width = max(map(len, known), default=0)
    parser = ProgramParser(
        prog=PROGRAM,
        usage='%(prog)s NAME [--ros-args -p PARAMETER:=VALUE ...]',
        description='Start one node of the graph. Its own --help has its parameters.\n\n'
        + '\n'.join(lines_of(known.values(), width)),
        epilog=_EXAMPLES,
    )
    parser.add_argument('name', metavar='NAME', help='one of those above')
    name = parser.parse_args(argv[:1]).name
    parser.error(f'unknown node {name}: {close_name(name, known)}')


if __name__ == '__main__':
    raise SystemExit(main())
