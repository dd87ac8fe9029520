# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Build the documentation site into a folder that opens from disk: `make docs`."""

import argparse
import shutil
import sys
import tempfile
from pathlib import Path

from sphinx.cmd.build import build_main

from ddct_plant.base.errors import DdctError
from website.staging import ROOT, stage


def build(out: Path, results: Path, theme: str = 'furo') -> int:
    """
    Build the site into a folder, which is replaced; return the exit code of Sphinx.

    Raise DdctError where `results` lacks a file that the site shows.
    """
    with tempfile.TemporaryDirectory(prefix='ddct_site_') as made:
        source, html = Path(made, 'source'), Path(made, 'html')
        stage(source)
        settings = str(Path(__file__).parent)
        code = build_main(
            ['-q', '-W', '--keep-going', '-b', 'html', '-c', settings, '-D', f'html_theme={theme}']
            + ['-D', f'ddct_results={results.resolve()}', str(source), str(html)]
        )
        if code == 0:
            shutil.rmtree(out, ignore_errors=True)
            shutil.copytree(html, out, ignore=shutil.ignore_patterns('.doctrees', '.buildinfo'))
            (out / 'COLCON_IGNORE').touch()  # a page may link to a copy of a package.xml
    return code


def main() -> int:
    """Build, and name the page to open."""
    parser = argparse.ArgumentParser(prog='make docs', description=__doc__)
    parser.add_argument('--out', type=Path, default=ROOT / 'site', help='folder of the site')
    parser.add_argument(
        '--results',
        type=Path,
        required=True,
        help='folder with numbers.json, benchmark.json and studies.json, which programs write',
    )
    options = parser.parse_args()
    out = options.out
    try:
        code = build(out, options.results)
    except DdctError as error:
        sys.exit(f'make docs: {error}')
    print(f'open {out / "index.html"}' if code == 0 else 'the site has warnings: see above')
    return code


if __name__ == '__main__':
    sys.exit(main())
