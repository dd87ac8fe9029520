# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Build the sdists and wheels of the four packages, and try the wheels in an empty environment."""

import argparse
import shutil
import sys
import tempfile
from pathlib import Path

from release.build import PLACEHOLDER, ROOT, ReleaseError, built, require_address
from release.trial import try_wheels


def main() -> int:
    """Leave the files in the folder once the trial has passed; return the exit code."""
    parser = argparse.ArgumentParser(prog='tools/run release', description=__doc__)
    parser.add_argument('--out', type=Path, default=Path('dist'), help='folder of the files')
    parser.add_argument('--maintainer', default='', help='address for package.xml')
    options = parser.parse_args()
    if options.maintainer:
        require_address(options.maintainer)
    with tempfile.TemporaryDirectory(prefix='ddct_release_') as made:
        folder = Path(made)
        wheels = built(folder / 'dist', options.maintainer)
        for line in try_wheels(wheels, folder / 'trial'):
            print(line, flush=True)
        shutil.rmtree(options.out, ignore_errors=True)
        shutil.copytree(folder / 'dist', options.out, ignore=shutil.ignore_patterns('.*'))
    for file in sorted(options.out.iterdir()):
        print(file)
    if not options.maintainer and PLACEHOLDER in (ROOT / 'ddct_plant' / 'package.xml').read_text():
        print(
            f'package.xml names {PLACEHOLDER}, which reaches nobody: before you publish these '
            'files, build them with tools/run release --maintainer name@domain'
        )
    return 0


if __name__ == '__main__':
    try:
        sys.exit(main())
    except ReleaseError as error:
        sys.exit(f'tools/run release: {error}')
