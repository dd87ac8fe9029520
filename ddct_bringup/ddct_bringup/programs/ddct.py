# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `ddct`: starts the programs of the installed packages by their names."""

from collections.abc import Mapping
from importlib.metadata import EntryPoint

from ddct_bringup import processes
from ddct_bringup.programs.node import node_names
from ddct_bringup.programs.starting import lines_of, start
from ddct_plant.base.options import close_name
from ddct_plant.graph.domain import require_ros
from ddct_plant.program.command_line import ProgramParser, programs, run_program

PROGRAM = 'ddct'
TASKS = {
    'Run and judge controllers': ('compare', 'check', 'benchmark', 'limit'),
    'Vary the plant, search the options': ('campaign', 'sweep', 'tune'),
    'Work with recorded runs and logs': ('score', 'report', 'verify', 'identify'),
    'More': ('live', 'design', 'node', 'thesis'),
}
"""Names of the programs by what they are for, in the order of --help."""
_OTHERS = 'Of other packages'
_RUNS_GRAPHS = 'compare'
"""The program whose fork server starts ahead of it, as both take about as long to import."""
_WITHOUT_NODES = {'-h', '--help', '--headless', '--list', '--single-process', '--version'}
"""Options with which it starts no node."""

_EXAMPLES = """\
examples:
  ddct compare --controllers pi,ls8 --out runs/first
  ddct compare --help
  ddct node controller --ros-args -p controller:=ls8
"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return the exit code of the one that it starts."""
    return run_program(PROGRAM, _ddct, argv)


def _ddct(argv: list[str]) -> int:
    known = programs()
    if not argv or argv[0] not in known:
        parser = ProgramParser(
            prog=PROGRAM,
            usage='%(prog)s PROGRAM [ARGUMENTS ...]',
            description='Simulate engagements of a dry clutch in closed loop, and judge '
            'controllers.\nEach program has its own --help.\n\n' + _listing(known),
            epilog=_EXAMPLES,
        )
        parser.add_argument('program', metavar='PROGRAM', help='one of those above')
        name = parser.parse_args(argv[:1]).program
        node = name in node_names()
        hint = (
            f'to start this node give ddct node {name}'
            if node
            else close_name(name, sorted(known))
        )
        parser.error(f'unknown program {name}: {hint}')
    if argv[0] == _RUNS_GRAPHS and _WITHOUT_NODES.isdisjoint(argv):
        failed = run_program(f'{PROGRAM} {argv[0]}', _start_server, argv[1:])
        if failed:
            return failed
    return start(known[argv[0]], argv[1:])


def _start_server(_: list[str]) -> int:
    require_ros()
    # Imported here: what is imported before `run_program` cannot be interrupted without a
    # traceback.
    processes.start_server()
    return 0


def _listing(known: Mapping[str, EntryPoint]) -> str:
    """Return a line per program, by task."""
    ours = {name for names in TASKS.values() for name in names}
    others = sorted(known.keys() - ours)
    width = max(map(len, known), default=0)
    lines = []
    for title, names in {**TASKS, **({_OTHERS: others} if others else {})}.items():
        points = [known[name] for name in names if name in known]
        lines += [f'{title}:', *lines_of(points, width), '']
    return '\n'.join(lines).rstrip()
