# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Charts of the studies: pictures with samples of their curves, for a test against runs."""

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from ddct_controllers.design.drawing.chart_style import save_chart

_CURVES = 'Curves'
"""Metadata key of the samples in a picture."""
_EVERY = 25
"""Number of steps of 10 ms between two samples."""
Curves = Mapping[str, Mapping[str, Sequence[int | None]]]
"""Samples of each line by panel and label; None for no number."""


def samples(values: np.ndarray) -> list[int | None]:
    """Return every 25th value of a curve with one value for each step, (n,), rounded."""
    chosen = values[::_EVERY].tolist()
    return [round(value) if math.isfinite(value) else None for value in chosen]


def curves_of(figure: Figure) -> Curves:
    """Return the samples of the labelled lines of a figure whose panels have titles."""
    return {
        axes.get_title(): {
            str(line.get_label()): samples(np.asarray(line.get_ydata()))
            for line in axes.get_lines()
            if not str(line.get_label()).startswith('_')
        }
        for axes in figure.axes
        if axes.get_title()
    }


def save_study_chart(figure: Figure, picture: Path) -> None:
    """Write a chart as PNG, with the samples of its curves as metadata."""
    curves = json.dumps(curves_of(figure))
    save_chart(figure, picture)
    metadata = PngInfo()
    metadata.add_text(_CURVES, curves, zip=True)
    with Image.open(picture) as image:
        image.load()
        image.save(picture, pnginfo=metadata, dpi=image.info['dpi'], optimize=True)


def drawn_curves(picture: Path) -> Curves:
    """Return the samples of the curves that a picture shows."""
    with Image.open(picture) as image:
        curves: Curves = json.loads(image.info[_CURVES])
    return curves
