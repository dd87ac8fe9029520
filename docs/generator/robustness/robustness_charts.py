# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Figures of docs/thesis/robustness_map.md."""

from collections.abc import Mapping
from itertools import product
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from ddct_bringup.reproduction.values.orders import WORN
from ddct_bringup.sweep.state_map import draw_states, edges_of, state_legend
from ddct_controllers.design.drawing.chart_style import chart_style, save_chart
from ddct_controllers.design.drawing.line_styles import BLACK
from generator.pages import DOCS
from generator.robustness.robustness_map import ARCHITECTURE, WEAR, StateMap
from generator.robustness.robustness_tables import PLANTS

DRAWN_FROM = 'Drawn from'
"""Metadata key of the digest of the map in a picture."""
LABELS = {'delay': ('delay, ms', 1e3), 'mass': ('mass, kg', 1.0)}
"""Label of the third key and factor from its SI unit to that of the label, by map."""


def pictures(maps: Mapping[str, StateMap]) -> dict[Path, tuple[str, str]]:
    """Return the map and the architecture of each picture, by file."""
    return {
        DOCS / 'images' / f'robustness_{name}_{architecture}.png': (name, architecture)
        for name, found in maps.items()
        for architecture in found.values(ARCHITECTURE)
    }


def draw_robustness(maps: Mapping[str, StateMap]) -> None:
    """Draw a figure per map and architecture into `images`, each with the digest of its map."""
    for picture, (name, architecture) in pictures(maps).items():
        with chart_style():
            save_chart(robustness_figure(maps[name], architecture, *LABELS[name]), picture)
        with Image.open(picture) as image:
            metadata = PngInfo()
            metadata.add_text(DRAWN_FROM, maps[name].digest)
            image.convert('P', palette=Image.Palette.ADAPTIVE).save(picture, pnginfo=metadata)


def robustness_figure(found: StateMap, architecture: str, label: str, factor: float) -> Figure:
    """Return a map per controller and plant: wear across, the third key up."""
    names, clutches, third = found.spec.controllers, tuple(PLANTS), found.values(found.third)
    figure = Figure(figsize=(11.0, 5.2))
    figure.suptitle(f'{architecture}: states over wear gain; dotted: the values of Table 5.2')
    panels = figure.subplots(len(clutches), len(names), sharex=True, sharey=True)
    rows = np.arange(len(third), dtype=float)
    edges = (edges_of(np.array(found.values(WEAR))), edges_of(rows))
    for (up, clutch), (across, name) in product(enumerate(clutches), enumerate(names)):
        axes = panels[up, across]
        draw_states(axes, edges, found.plane(name, architecture, clutch))
        for worn in WORN:
            axes.axvline(worn, color=BLACK, linestyle=':', linewidth=1.0)
        axes.set_xticks(
            [0.5, *WORN, 1.0, 1.5], ['0.5', *(f'{worn:g}' for worn in WORN), '1', '1.5']
        )
        axes.tick_params(axis='x', labelsize=8)
        if not up:
            axes.set_title(name)
        if not across:
            axes.set_ylabel(f'{PLANTS[clutch]}: {label}')
            axes.set_yticks(rows, [f'{factor * value:g}' for value in third])
    planes = found.states[:, found.values(ARCHITECTURE).index(architecture)]
    state_legend(figure, set(planes.ravel().tolist()))
    return figure
