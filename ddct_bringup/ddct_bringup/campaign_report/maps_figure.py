# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The maps of a campaign on its page: one for each group, over two chosen numbers."""

from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

from ddct_bringup.campaign_report.map_types import CampaignMaps, MapScale
from ddct_bringup.campaign_report.maps import FAILED_SHARE
from ddct_bringup.documents.bokeh_charts import chart_place, styled_figure
from ddct_bringup.documents.page import Drawing
from ddct_bringup.documents.page_parts import json_data, page_part, page_template
from ddct_bringup.documents.palette import NEUTRAL
from ddct_plant.files.json_records import to_json

if TYPE_CHECKING:
    from bokeh.plotting import figure

_ROOM = 'ddct_bringup.campaign_report'
_SHOWN_FIRST = (FAILED_SHARE, 'peak_jerk_m_s3')
"""Quantities that the maps show when the page opens, the first available one of these."""
_HEIGHT_PX = 320
_SHAPES = ('x', 'y', 'width', 'height', 'colour', 'hatch', 'mark', 'text', 'place')
_WORDS = ('x', 'y', 'word', 'colour', 'ground')
"""Columns that the script of the page fills."""


def maps_drawing(maps: CampaignMaps, replay: str) -> Drawing:
    """Return the maps; `replay` is the command that makes the bag of the run INDEX."""
    places = {f'map-{number}': label for number, label in enumerate(maps.groups)}
    html = page_template(_ROOM, 'maps.html.j2').render(
        maps=maps,
        places={place: (label, chart_place(place)) for place, label in places.items()},
        chosen=_chosen(maps.quantities),
        data=json_data({'maps': to_json(maps), 'ramp': _ramp(), 'replay': replay}),
    )
    return Drawing(
        html,
        {place: _map_figure() for place in places},
        page_part(_ROOM, 'maps.css'),
        page_part(_ROOM, 'maps.js'),
    )


def _map_figure() -> 'figure':
    """Return the empty figure of one group: cells of a grid, points of samples, and words."""
    from bokeh.models import ColumnDataSource, HoverTool, TapTool

    drawn = styled_figure(
        _HEIGHT_PX,
        tools='box_zoom,pan,reset,save',
        active_drag=None,
        window_axis='none',
        x_range=(0.0, 1.0),
        y_range=(0.0, 1.0),
    )
    drawn.grid.visible = False
    look: dict[str, Any] = {
        'fill_color': 'colour',
        'hatch_pattern': 'hatch',
        'hatch_color': NEUTRAL,
    }
    look |= {'line_color': NEUTRAL, 'hatch_scale': 12.0, 'selection_line_width': 3}
    look |= {'nonselection_alpha': 1.0, 'nonselection_hatch_alpha': 1.0}
    cells = drawn.rect(
        'x',
        'y',
        'width',
        'height',
        source=ColumnDataSource({name: [] for name in _SHAPES}),
        name='cells',
        line_width=0.5,
        **look,
    )
    points = drawn.scatter(
        'x',
        'y',
        size=9,
        marker='mark',
        source=ColumnDataSource({name: [] for name in _SHAPES}),
        name='points',
        line_width=1.5,  # the darkest and the lightest ones show on any page by their edge
        **look,
    )
    words: dict[str, Any] = {'background_fill_color': 'ground', 'padding': 2}
    drawn.text(
        'x',
        'y',
        text='word',
        text_color='colour',
        text_align='center',
        text_baseline='middle',
        text_font_size='11px',
        **words,
        source=ColumnDataSource({name: [] for name in _WORDS}),
        name='words',
    )
    shapes: list[Any] = [cells, points]
    drawn.add_tools(
        HoverTool(renderers=shapes, tooltips=[('', '@text')], visible=False),
        TapTool(renderers=shapes, visible=False),
    )
    return drawn


def _chosen(quantities: Sequence[MapScale]) -> int:
    """Return the index of the quantity that the maps show when the page opens."""
    keys = [each.key for each in quantities]
    return next((keys.index(key) for key in _SHOWN_FIRST if key in keys), 0)


@cache
def _ramp() -> tuple[str, ...]:
    """
    Return colours from dark to light, readable for colour-blind people.

    They are those of Nunez, Anderton and Renslow 2018.
    """
    from bokeh.palettes import Cividis256

    return tuple(Cividis256[17 * step] for step in range(16))
