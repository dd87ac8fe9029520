"""A figure as files: a picture, a drawing to scale, and its data."""

from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ddct_controllers.design.drawing.chart_style import save_chart
from ddct_plant.files.csv_table import csv_text
from ddct_plant.files.output_file import write_text

ENDINGS = ('.png', '.svg', '.csv')

Column = tuple[str, np.ndarray]
"""Heading with the unit, and the values, (n,)."""


def figure_files(folder: Path, name: str) -> list[Path]:
    """Return the files that `save_figure` writes."""
    return [folder / f'{name}{ending}' for ending in ENDINGS]


def save_figure(figure: Figure, folder: Path, name: str) -> None:
    """
    Write a figure as NAME.png, NAME.svg and NAME.csv into the folder.

    Raise DdctError when a file cannot be written.
    """
    picture, drawing, data = figure_files(folder, name)
    write_text(str(data), _as_csv(figure_data(figure)))  # before symbols become typeset
    save_chart(figure, picture)
    save_chart(figure, drawing)


def figure_data(figure: Figure) -> list[Column]:
    """
    Return the labelled lines of a figure as columns.

    Lines over the same values share that column. A heading is the axis label with its unit, after
    the title of the panel where there are several and the name of the curve. Lines across the
    whole panel, such as a reference of 1, have no data.
    """
    panels = figure.axes
    columns: dict[tuple[str, bytes], Column] = {}
    for axes in panels:
        before = f'{axes.get_title()}: ' if len(panels) > 1 and axes.get_title() else ''
        for heading, values in _panel_data(axes):
            columns[before + heading, values.tobytes()] = before + heading, values
    return list(columns.values())


def _as_csv(columns: list[Column]) -> str:
    """Return columns as CSV; a shorter one ends in empty cells."""
    cells = ([f'{value:.9g}' for value in values] for _, values in columns)
    return csv_text((heading for heading, _ in columns), zip_longest(*cells, fillvalue=''))


def _panel_data(axes: Axes) -> Iterator[Column]:
    groups: dict[bytes, list[Line2D]] = {}
    for line in axes.get_lines():
        labelled = not str(line.get_label()).startswith('_')
        if labelled and line.get_transform() == axes.transData and np.size(line.get_xdata()):
            groups.setdefault(np.asarray(line.get_xdata(), dtype=float).tobytes(), []).append(line)
    for lines in groups.values():
        across = axes.get_xlabel() if len(groups) == 1 else f'{_names(lines)}: {axes.get_xlabel()}'
        yield across, np.asarray(lines[0].get_xdata(), dtype=float)
        for line in lines:
            up = np.asarray(line.get_ydata(), dtype=float)
            yield f'{line.get_label()}: {axes.get_ylabel()}', up


def _names(lines: list[Line2D]) -> str:
    return ' and '.join(str(line.get_label()) for line in lines)
