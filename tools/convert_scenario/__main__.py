# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Convert a scenario file of before into a car, a drive and a scenario with the same numbers.

    tools/run convert_scenario old.yaml --out new.yaml

The car stands in new_car.yaml with what differs from the packaged C635, the drive in
new_drive.yaml. A file of before says nothing about its clutch: give the model that its runs had.
"""

import argparse
import sys
from pathlib import Path

from convert_scenario.conversion import converted
from ddct_plant.base.clutch_kinds import CLUTCHES, LINEAR
from ddct_plant.base.errors import DdctError
from ddct_plant.files.output_file import require_new, require_place, write_text
from ddct_plant.scenario.file import load_scenario


def main(arguments: list[str] | None = None) -> int:
    """Run the program and return its exit code."""
    parser = argparse.ArgumentParser(
        prog='tools/run convert_scenario',
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument('file', type=Path, help='the scenario file of before')
    parser.add_argument('--out', type=Path, required=True, help='the scenario file to write')
    parser.add_argument(
        '--clutch', choices=CLUTCHES, default=LINEAR, help='its clutch; default: %(default)s'
    )
    options = parser.parse_args(arguments)
    try:
        require_place('--out', str(options.out))
        texts = converted(options.file, options.out, options.clutch)
        for path in texts:
            require_new('--out', path, overwrite=False)
        for path, text in texts.items():
            write_text(str(path), text)
        load_scenario(str(options.out.resolve()))
    except DdctError as error:
        print(f'convert_scenario: {error}', file=sys.stderr)
        return 1
    print(*texts, sep='\n')
    return 0


if __name__ == '__main__':
    raise SystemExit(main())
