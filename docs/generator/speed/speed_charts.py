# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Charts of docs/develop/speed.md: cost per step over nodes, topics, horizon and runs."""

from collections.abc import Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from ddct_controllers.design.drawing.chart_style import chart_style, save_chart
from generator.pages import DOCS
from generator.speed.speed_history import MachineHistory

DRAWN_FROM = 'Drawn from'
"""Metadata key of the digest of the history in a picture."""
PICTURE = DOCS / 'images' / 'speed.png'
PANELS = {
    'nodes': ('nodes', 'bare chain of 8 nodes', False),
    'topics': ('topics with every tick', 'bare chain of 8 nodes', False),
    'prediction steps': ('prediction steps', 'plain numpy loop', True),
    'runs': ('runs in a batch', 'plain numpy loop', True),
}
"""Label of the abscissa, unit of the cost per step, whether the abscissa is logarithmic."""
MARKERS = 'os^Dvx'
"""Markers of the kinds of machines."""


def draw_speed(machines: Sequence[MachineHistory], digest: str, picture: Path = PICTURE) -> None:
    """Draw the picture with the digest of the history in it."""
    with chart_style():
        save_measured(speed_figure(machines), digest, picture)


def save_measured(figure: Figure, digest: str, picture: Path) -> None:
    """Save a chart of something measured, with the digest of its record in it."""
    save_chart(figure, picture)
    with Image.open(picture) as image:
        metadata = PngInfo()
        metadata.add_text(DRAWN_FROM, digest)
        image.convert('P', palette=Image.Palette.ADAPTIVE).save(picture, pnginfo=metadata)


def speed_figure(machines: Sequence[MachineHistory]) -> Figure:
    """Return a panel for each abscissa: medians as lines, the spread of the rounds as bars."""
    figure = Figure(figsize=(11.0, 7.5), layout='constrained')
    figure.suptitle('Cost per step: median of the rounds, bars from the least to the most')
    for axes, abscissa in zip(figure.subplots(2, 2).flat, PANELS, strict=True):
        _draw_panel(axes, abscissa, machines)
    return figure


def _draw_panel(axes: Axes, abscissa: str, machines: Sequence[MachineHistory]) -> None:
    label, unit, logarithmic = PANELS[abscissa]
    colours: dict[str, str] = {}
    for machine, marker in zip(machines, MARKERS, strict=False):
        for name, points in machine.curve(abscissa).items():
            colour = colours.setdefault(name, f'C{len(colours)}')
            x, median, least, most = zip(*points, strict=True)
            text = name if len(machines) == 1 else f'{machine.letter}: {name}'
            below = [a - b for a, b in zip(median, least, strict=True)]
            above = [b - a for a, b in zip(median, most, strict=True)]
            axes.errorbar(
                x, median, [below, above], color=colour, marker=marker, capsize=3, label=text
            )
    axes.set_xlabel(label)
    axes.set_ylabel(f'cost per step, 1 = {unit}')
    if logarithmic:
        axes.set_xscale('log')
    if abscissa == 'runs':
        axes.set_yscale('log')
    else:
        axes.set_ylim(bottom=0.0)
    if colours:
        axes.legend()
