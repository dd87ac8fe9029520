# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Charts of a page by Bokeh: their style, and the document that the page's script draws."""

from collections.abc import Mapping, Sequence
from functools import cache, partial
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from markupsafe import Markup, escape

from ddct_bringup.documents.chart import (
    Area,
    Cells,
    Chart,
    Item,
    Key,
    Line,
    Marks,
    Panel,
    legend,
)
from ddct_bringup.documents.palette import NEUTRAL, mark_svg, patch_svg, sample_svg

_LABELS_PX = 70
"""Width left of panels below each other, so that equal times are below each other too."""

if TYPE_CHECKING:
    from bokeh.models import Model, Range
    from bokeh.models.renderers import GlyphRenderer
    from bokeh.plotting import figure


@cache
def library() -> Markup:
    """Return BokehJS from the installed package, for a script element of a page."""
    from bokeh.resources import Resources

    # At a lower log level it warns about charts without a visible line.
    return Markup('\n'.join(Resources('inline', components=['bokeh'], log_level='error').js_raw))


def styled_figure(
    height_px: int,
    *,
    tools: str = 'xbox_zoom,xpan,xwheel_zoom,reset,save',
    active_drag: str | None = 'xbox_zoom',
    window_axis: Literal['none', 'x'] = 'x',
    **options: Any,
) -> 'figure':
    """
    Return an empty figure in the style of all pages; `options` are Bokeh's.

    It fills the width of its place. Text, axes and grid have the colours of the page's style.
    """
    from bokeh.plotting import figure

    chart = figure(
        height=height_px,
        tools=tools,
        active_drag=active_drag,
        active_scroll=None,
        window_axis=window_axis,
        sizing_mode='stretch_width',
        background_fill_color=None,
        border_fill_color=None,
        outline_line_color=None,
        min_border=6,
        **options,
    )
    chart.toolbar.logo = None
    chart.xgrid.grid_line_color = None
    chart.axis.axis_label_text_font_style = 'normal'
    chart.axis.minor_tick_line_color = None
    return chart


def bokeh_json(figures: 'Sequence[Model]') -> tuple[Mapping[str, object], list[str]]:
    """Return the Bokeh document of figures as JSON, and the id of each figure in it."""
    from bokeh.document import Document

    document = Document()
    with document.models.freeze():  # or it would be searched for models after each chart
        for each in figures:
            document.add_root(each)
    ids: dict[str, str] = {}
    content = _with_fixed_ids(document.to_json(deferred=False), ids)
    return content, [ids[str(each.id)] for each in figures]


def _with_fixed_ids(content: Any, ids: dict[str, str]) -> Any:
    """
    Return the JSON of a document with ids that count its models, so that it comes out again.

    Bokeh's own count all models of the process. `ids` gets the new ones by the old.
    """
    if isinstance(content, Mapping):
        return {
            key: ids.setdefault(value, f'p{len(ids)}')
            if key == 'id' and isinstance(value, str)
            else _with_fixed_ids(value, ids)
            for key, value in content.items()
        }
    if isinstance(content, (list, tuple)):
        return [_with_fixed_ids(each, ids) for each in content]
    return content


class PageCharts:
    """The charts of one page, by the ids of their places on it."""

    def __init__(self) -> None:
        self._figures: dict[str, figure] = {}

    def __bool__(self) -> bool:
        """Whether the page has a chart."""
        return bool(self._figures)

    def add(self, chart: Chart, words: str = '') -> Markup:
        """
        Return the places of a chart's panels and its legend, for the page.

        `words` say what it shows, for those who do not see it.
        """
        places = []
        for drawn in draw_chart(chart):
            place = f'chart-{len(self._figures)}'
            self._figures[place] = drawn
            places.append(chart_place(place))
        several = ' several' if chart.columns > 1 else ''
        spoken = Markup(' role="img" aria-label="{}"').format(words) if words else ''
        keys = [f'<span>{key_sample(key)}{escape(key.label)}</span>' for key in legend(chart)]
        panels = f'<div class="panels{several}"{spoken}>{"".join(places)}</div>'
        return Markup(panels + (f'<p class="legend">{"".join(keys)}</p>' if keys else ''))

    def add_figure(self, place: str, drawn: 'figure') -> None:
        """Add a figure of Bokeh, whose place is already on the page."""
        self._figures[place] = drawn

    @property
    def data(self) -> dict[str, object]:
        """What `drawCharts` of the page's script takes: the document, and ids by place."""
        if not self:  # importing Bokeh takes as long as many runs
            return {'document': None, 'roots': {}}
        document, ids = bokeh_json(list(self._figures.values()))
        return {'document': document, 'roots': dict(zip(self._figures, ids, strict=True))}


def chart_place(place: str) -> Markup:
    """Return the place of a chart on a page: on a screen, and its copy on paper."""
    return Markup('<div><div class="chart" id="{}"></div><div class="paper"></div></div>').format(
        place
    )


def draw_chart(chart: Chart) -> 'list[figure]':
    """Return the Bokeh figure of each panel of a chart."""
    shared: dict[str, Range] = {}
    return [_draw_panel(chart, panel, shared) for panel in chart.panels]


def key_sample(key: Key) -> Markup:
    """Return the sample of an entry of the legend as an SVG element."""
    item = key.item
    if isinstance(item, Line):
        return sample_svg(item.look)
    if isinstance(item, Marks):
        return mark_svg(item.mark, item.colour, filled=item.filled)
    if isinstance(item, Area):
        return patch_svg(item.colour, item.opacity)
    return patch_svg(next(iter(item.colours.values())))


def _draw_panel(chart: Chart, panel: Panel, shared: 'dict[str, Range]') -> 'figure':
    """Return the figure of a panel; `shared` has the ranges of those before it by x and y."""
    from bokeh.models import DataRange1d
    from bokeh.models.annotations import Title

    down = panel.y.span[::-1] if panel.downward and panel.y.span else panel.y.span
    drawn = styled_figure(
        panel.height_px,
        tools='box_zoom,pan,reset,save',
        active_drag=None,
        window_axis='none',
        title=Title(text=panel.title, text_color=NEUTRAL),
        x_range=shared.get('x') or panel.x.span or DataRange1d(),
        y_range=shared.get('y') or down or DataRange1d(),
        x_axis_label=panel.x.label or None,
        y_axis_label=panel.y.label or None,
        x_axis_type='log' if panel.x.logarithmic else 'linear',
        y_axis_type='log' if panel.y.logarithmic else 'linear',
    )
    if chart.columns == 1:
        drawn.min_border_left = _LABELS_PX
    if chart.same_x:
        shared['x'] = drawn.x_range
    if chart.same_y:
        shared['y'] = drawn.y_range
    for axis, its in ((panel.x, drawn.xaxis), (panel.y, drawn.yaxis)):
        if axis.ticks is not None:
            its.ticker = list(axis.ticks)
            its.major_label_overrides = dict(axis.ticks.items())
    for item in panel.items:
        _draw(drawn, item, panel)
    return drawn


def _draw(drawn: 'figure', item: Item, panel: Panel) -> None:
    """Draw one item of a panel, with what stands beside the pointer."""
    if isinstance(item, Line):
        mark = _draw_line(drawn, item)
    elif isinstance(item, Marks):
        mark = drawn.scatter(
            _single(item.x),
            _single(item.y),
            marker=item.mark,
            size=item.size,
            line_color=item.colour,
            line_width=1.5,
            fill_color=item.colour if item.filled else None,
            alpha=item.opacity,
            level='annotation' if item.whole else 'glyph',
        )
    elif isinstance(item, Area):
        drawn.varea(
            _single(item.x),
            _single(item.low),
            _single(item.high),
            fill_color=item.colour,
            fill_alpha=item.opacity,
        )
        return
    else:
        _draw_cells(drawn, item)
        return
    hint = item.label
    if isinstance(item, Marks):
        hint = item.hint or item.label
    if hint:
        names = (panel.x.label or 'x', '$snap_x'), (panel.y.label or 'y', '$snap_y')
        _add_hover(drawn, mark, [('', hint), *names])


def _draw_line(drawn: 'figure', item: Line) -> 'GlyphRenderer[Any]':
    across, up = _single(item.x), _single(item.y)
    if item.look.mark:
        drawn.scatter(across, up, marker=item.look.mark, size=7, color=item.look.colour)
    draw = partial(drawn.step, mode='after') if item.steps else drawn.line
    return draw(
        across,
        up,
        line_color=item.look.colour,
        line_dash=list(item.look.dash),
        line_width=item.width,
        line_alpha=item.opacity,
    )


def _draw_cells(drawn: 'figure', item: Cells) -> None:
    across, up = _single(item.across), _single(item.up)
    rows, columns = len(up) - 1, len(across) - 1
    names = [name for row in item.names for name in row]
    source = {
        'left': np.tile(across[:-1], rows),
        'right': np.tile(across[1:], rows),
        'bottom': np.repeat(up[:-1], columns),
        'top': np.repeat(up[1:], columns),
        'name': [name.replace('_', ' ') for name in names],
        'colour': [item.colours[name] for name in names],
    }
    from bokeh.models import ColumnDataSource

    cells = drawn.quad(
        left='left',
        right='right',
        bottom='bottom',
        top='top',
        fill_color='colour',
        line_color='#ffffff',
        line_width=0.5,
        source=ColumnDataSource(source),
    )
    drawn.grid.grid_line_color = None
    _add_hover(drawn, cells, [('', '@name')])


def _add_hover(
    drawn: 'figure', mark: 'GlyphRenderer[Any]', tooltips: list[tuple[str, str]]
) -> None:
    from bokeh.models import HoverTool

    drawn.add_tools(
        HoverTool(renderers=[mark], tooltips=tooltips, line_policy='nearest', visible=False)
    )


def _single(values: np.ndarray) -> np.ndarray:
    """Return numbers in single precision, which draws the same and halves the page."""
    return np.asarray(values, dtype=np.float32)
