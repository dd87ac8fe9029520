# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Compute the rows of the packaged controllers on the development cases: a minute or two.

They are written into the sources. A start after an interruption goes on with what is in
runs/benchmark_rows, unless the sources have changed since: then remove that folder first.
"""

import argparse
import sys
from pathlib import Path

from ddct_bringup.benchmark.cases import packaged_folder
from ddct_bringup.benchmark.release import PROGRAM, write_release_rows
from ddct_plant.program.command_line import run_program

WORK = Path('runs') / 'benchmark_rows'


def _main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(
        prog=PROGRAM, description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument('--work', type=Path, default=WORK, help=f'folder of the runs ({WORK})')
    options = parser.parse_args(argv)
    write_release_rows(options.work, Path(str(packaged_folder())))
    return 0


if __name__ == '__main__':
    sys.exit(run_program(PROGRAM, _main, None))
