# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `live`: show the running graph in Foxglove."""

import argparse
import os
from functools import partial

from ddct_bringup.api import shell
from ddct_bringup.programs.options.of_runs import DEFAULT_PORT
from ddct_plant.base.errors import ParameterError
from ddct_plant.graph.domain import require_ros
from ddct_plant.program.command_line import ProgramParser, run_program, split_ros_arguments

PROGRAM = 'ddct live'
_LAST_PORT = 65_535
_NICENESS = 10

_EPILOG = """\
examples:
  ddct live                   serve ROS domain 0, or that of ROS_DOMAIN_ID
  ddct live --port 9000       another port; 0 takes a free one
  ddct live --host 0.0.0.0    let other machines connect, with no password
  ddct compare --controllers pi --live --out DIR    a run in a domain of its own, with its view

Open the printed address in Foxglove: Open connection, Foxglove WebSocket. The graph may start
before or after; Ctrl-C ends the server. Arguments behind --ros-args go to the node.
"""


def main(argv: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    return run_program(PROGRAM, _live, argv)


def _live(argv: list[str]) -> int:
    own, _ = split_ros_arguments(argv)
    options = _parser().parse_args(own)
    require_ros()
    if not 0 <= options.port <= _LAST_PORT:
        raise ParameterError(f'--port is {options.port}: give a number from 0 to {_LAST_PORT}')
    # On a busy machine the nodes of the loop have priority; messages for this one are buffered.
    os.nice(_NICENESS)
    print_line = partial(print, f'{PROGRAM}:', flush=True)
    factory = partial(shell.LiveNode, options.host, options.port, print_line)
    return shell.run_node(PROGRAM, factory, [PROGRAM, *argv])


def _parser() -> argparse.ArgumentParser:
    parser = ProgramParser(
        prog=PROGRAM,
        description='Serve the running graph to Foxglove over WebSocket, on the simulated time.',
        epilog=_EPILOG,
    )
    parser.add_argument('--host', default='127.0.0.1', help='default: %(default)s')
    parser.add_argument('--port', type=int, default=DEFAULT_PORT, help='default: %(default)s')
    return parser


if __name__ == '__main__':
    raise SystemExit(main())
