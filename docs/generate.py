# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Write what is generated in the pages: tables, diagrams and notebooks."""

import argparse
import sys

from generator.drawings.block_diagrams import drawings
from generator.notebooks import write_notebooks
from generator.pages import DOCS, fill_pages
from generator.tables import TABLES

from ddct_plant.base.errors import DdctError

DIAGRAMS = 'diagrams'
NOTEBOOKS = 'notebooks'


def main() -> None:
    """Write all, or the kinds that are named, and tell which pages have changed."""
    parser = argparse.ArgumentParser(description=__doc__, epilog='all of it takes minutes')
    kinds = (DIAGRAMS, *TABLES, NOTEBOOKS)
    parser.add_argument('kind', nargs='*', help=f'some of {", ".join(kinds)} (default: all)')
    wanted = parser.parse_args().kind or kinds
    if unknown := set(wanted) - set(kinds):
        parser.error(f'no kind {", ".join(sorted(unknown))}: choose from {", ".join(kinds)}')
    for kind in wanted:
        print(f'docs: {kind}', file=sys.stderr, flush=True)
        if kind == DIAGRAMS:
            for file, drawing in drawings().items():
                (DOCS / 'images' / file).write_text(drawing, encoding='utf-8')
            continue
        notebooks = kind == NOTEBOOKS
        for page in write_notebooks() if notebooks else fill_pages(kind, TABLES[kind]()):
            print(f'docs: {page.relative_to(DOCS.parent)} has changed')


if __name__ == '__main__':
    try:
        main()
    except DdctError as error:
        sys.exit(f'docs: {error}')
