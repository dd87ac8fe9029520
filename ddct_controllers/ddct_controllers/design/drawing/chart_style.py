# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Style of all charts, and their files: PNG, SVG (scalable) and CSV (the data)."""

import io
import re
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager
from itertools import zip_longest
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np

from ddct_controllers.design.drawing.line_styles import LINE_WIDTH
from ddct_plant.files.csv_table import csv_text
from ddct_plant.files.output_file import write_bytes, write_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

INDEXED_SYMBOL = re.compile(r'(?<!\w)([A-Za-zζωσ])_([A-Za-z0-9]+)(?:\^(-?\d+))?')
"""Pattern of a symbol with an index and optionally a power, such as W_s^-1."""
_LETTERS_IN = 10.0
"""Number of letters of a title per inch of width."""
_MOST_NAMED = 8
ENDINGS = ('.png', '.svg', '.csv')
CsvColumn = tuple[str, np.ndarray]
"""Column of a CSV file: its heading with the unit, and its values, (n,)."""
_STYLE: dict[Any, Any] = {
    'figure.figsize': (8.0, 5.0),
    'figure.dpi': 130.0,
    'figure.constrained_layout.use': True,
    'figure.constrained_layout.w_pad': 0.1,
    'figure.constrained_layout.h_pad': 0.08,
    'font.size': 11.0,
    'axes.titlesize': 12.0,
    'axes.grid': True,
    'axes.axisbelow': True,
    'axes.spines.top': False,
    'axes.spines.right': False,
    'grid.color': '#d8d8d8',
    'grid.linewidth': 0.6,
    'lines.linewidth': LINE_WIDTH,
    'legend.fontsize': 10.0,
    'legend.framealpha': 0.9,
    'svg.hashsalt': 'ddct',
}


def chart_style() -> AbstractContextManager[None]:
    """Return the context with the style of charts, in which charts are made and saved."""
    import matplotlib

    return matplotlib.rc_context(_STYLE)


def new_chart(title: str, panels: int = 1) -> 'tuple[Figure, list[Axes]]':
    """Return a figure with this title and `panels` axes side by side."""
    from matplotlib.figure import Figure

    figure = Figure()
    figure.suptitle(title)
    axes = figure.subplots(1, panels, squeeze=False)
    return figure, list(axes[0])


def headed(title: str, conditions: str, width_in: float) -> str:
    """Return a title with the conditions below it, wrapped to a figure of `width_in` inches."""
    columns = int(_LETTERS_IN * width_in)
    return '\n'.join(line for text in (title, conditions) for line in wrap(text, columns))


def controllers_text(names: Sequence[str]) -> str:
    """Return the names of the controllers for a title, or their number when they are many."""
    return ', '.join(names) if len(names) <= _MOST_NAMED else f'{len(names)} controllers'


def save_chart(figure: 'Figure', path: Path) -> None:
    """
    Write the figure to a file of the kind of its extension, `.png` or `.svg`.

    Symbols such as w_sr or W_s^-1 are typeset. Raise DdctError when the file cannot be written.
    """
    write_bytes(str(path), chart_bytes(figure, path.suffix.removeprefix('.')))


def chart_bytes(figure: 'Figure', kind: str) -> bytes:
    """Return the figure as a file of a kind, `png` or `svg`, with its symbols typeset."""
    from matplotlib.text import Text

    for text in figure.findobj(Text):
        text.set_text(typeset(text.get_text()))
    content = io.BytesIO()
    # Without the date the same figure is the same file.
    metadata = {'Date': None} if kind == 'svg' else None
    figure.savefig(content, format=kind, metadata=metadata)
    return content.getvalue()


def typeset(text: str) -> str:
    """Return the text with its indexed symbols in matplotlib's mathematical notation."""
    return text if '$' in text else INDEXED_SYMBOL.sub(_mathematics, text)


def _mathematics(symbol: re.Match[str]) -> str:
    letter, index, power = symbol.groups()
    exponent = f'^{{{power}}}' if power else ''
    return f'${letter}_{{{index}}}{exponent}$'


def figure_files(folder: Path, name: str) -> list[Path]:
    """Return the files that `save_figure` writes."""
    return [folder / f'{name}{ending}' for ending in ENDINGS]


def save_figure(figure: 'Figure', folder: Path, name: str) -> None:
    """
    Write a figure as NAME.png, NAME.svg and NAME.csv into the folder.

    Raise DdctError when a file cannot be written.
    """
    picture, drawing, data = figure_files(folder, name)
    columns = figure_data(figure)  # before symbols become typeset
    cells = ([f'{value:.9g}' for value in values] for _, values in columns)
    rows = zip_longest(*cells, fillvalue='')  # a shorter column ends in empty cells
    write_text(str(data), csv_text((heading for heading, _ in columns), rows))
    save_chart(figure, picture)
    figure.set_layout_engine('none')  # the drawing has the places of the picture
    save_chart(figure, drawing)


def figure_data(figure: 'Figure') -> list[CsvColumn]:
    """
    Return the labelled lines of a figure as columns.

    Lines over the same x values share the column of these values. A heading is the
    axis label with its unit, after the name of the curve, and after the title of the panel where
    there are several. Lines across the
    whole panel, such as a reference of 1, have no data.
    """
    panels = figure.axes
    columns: dict[tuple[str, bytes], CsvColumn] = {}
    for axes in panels:
        before = f'{axes.get_title()}: ' if len(panels) > 1 and axes.get_title() else ''
        for heading, values in _panel_data(axes):
            columns[before + heading, values.tobytes()] = before + heading, values
    return list(columns.values())


def _panel_data(axes: 'Axes') -> Iterator[CsvColumn]:
    groups: dict[bytes, list[Line2D]] = {}
    for line in axes.get_lines():
        labelled = not str(line.get_label()).startswith('_')
        if labelled and line.get_transform() == axes.transData and np.size(line.get_xdata()):
            groups.setdefault(np.asarray(line.get_xdata(), dtype=float).tobytes(), []).append(line)
    for lines in groups.values():
        names = ' and '.join(str(line.get_label()) for line in lines)
        across = axes.get_xlabel() if len(groups) == 1 else f'{names}: {axes.get_xlabel()}'
        yield across, np.asarray(lines[0].get_xdata(), dtype=float)
        for line in lines:
            up = np.asarray(line.get_ydata(), dtype=float)
            yield f'{line.get_label()}: {axes.get_ylabel()}', up
