# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Execute the notebooks and keep their outputs.

Outputs stand in the files, so that a reader without Python sees them. Texts and tables are the
same in every execution, and a test compares them; pictures are kept, not compared. The outputs of
a cell with the metadata `varies: true` are not compared: they depend on the code of this release.
"""

import tempfile
from pathlib import Path
from typing import Any

from ddct_plant.base.errors import DdctError

FOLDER = Path(__file__).resolve().parents[2] / 'docs' / 'notebooks'
KERNEL = {'display_name': 'Python 3', 'language': 'python', 'name': 'python3'}
VARIES = 'varies'
"""Key of the metadata of a cell whose outputs depend on the code of this release."""
PICTURE = 'image/png'
_LONGEST_CELL_S = 900


def notebooks() -> list[Path]:
    """Return the notebooks in their order."""
    return sorted(FOLDER.glob('*.ipynb'))


def read_notebook(path: Path) -> Any:
    """Return a notebook; raise DdctError without nbclient and what comes with it."""
    try:
        import nbformat
    except ImportError as error:
        raise DdctError(f'notebooks need nbclient ({error}): make setup EXTRAS=test') from error
    return nbformat.read(path, as_version=4)


def executed(path: Path, first: str = '') -> Any:
    """
    Return a notebook with the outputs of a new process in an empty folder.

    `first` is code that runs before its cells, and is no part of it. Raise the error of nbclient
    for a cell that fails.
    """
    notebook = read_notebook(path)
    from nbclient import NotebookClient
    from nbformat.v4 import new_code_cell

    notebook.cells.insert(0, new_code_cell(first))
    with tempfile.TemporaryDirectory(prefix='ddct_notebook_') as folder:
        NotebookClient(
            notebook,
            kernel_name=KERNEL['name'],
            extra_arguments=['--log-level=ERROR'],
            timeout=_LONGEST_CELL_S,
            record_timing=False,
            resources={'metadata': {'path': folder}},
        ).execute()
    del notebook.cells[0]
    notebook.metadata = {'kernelspec': KERNEL}
    for number, cell in enumerate(_code_cells(notebook), start=1):
        cell.execution_count = number
        cell.outputs = [each for each in cell.outputs if each.get('name') != 'stderr']  # progress
        for output in cell.outputs:
            if 'execution_count' in output:
                output.execution_count = number
    return notebook


def write_notebooks() -> list[Path]:
    """Execute every notebook, write it with its outputs, and return those that have changed."""
    changed = []
    for path in notebooks():
        old = path.read_text(encoding='utf-8')
        notebook = executed(path)
        import nbformat

        nbformat.write(notebook, path)
        if path.read_text(encoding='utf-8') != old:
            changed.append(path)
    return changed


def texts_of(notebook: Any) -> list[list[dict[str, str]]]:
    """Return the texts that each cell of code puts out, by kind; none of a cell that varies."""
    return [
        []
        if cell.metadata.get(VARIES)
        else [
            {'stream': each.text}
            if each.output_type == 'stream'
            else {kind: text for kind, text in each.data.items() if kind != PICTURE}
            for each in cell.outputs
        ]
        for cell in _code_cells(notebook)
    ]


def pictures_of(notebook: Any) -> list[str]:
    """Return the alternative text of each cell with pictures, empty where it has none."""
    return [
        cell.metadata.get('alt', '')
        for cell in _code_cells(notebook)
        if any(PICTURE in each.get('data', {}) for each in cell.outputs)
    ]


def _code_cells(notebook: Any) -> list[Any]:
    return [cell for cell in notebook.cells if cell.cell_type == 'code']
