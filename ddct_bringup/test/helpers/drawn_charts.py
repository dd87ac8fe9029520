# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time charts by name: as they are drawn, and as a page loads them; pages without them."""

from collections.abc import Sequence
from typing import Any

import pytest

from ddct_bringup.documents.bokeh_charts import PageCharts
from ddct_bringup.report.chart_marks import ChartRun
from ddct_bringup.report.charts import time_charts


def leave_out_time_charts(patch: pytest.MonkeyPatch) -> None:
    """Draw no time chart on reports, which takes most of the time of one."""
    patch.setattr('ddct_bringup.report.page.time_charts', lambda runs, page: [])


class _Kept(PageCharts):
    """The charts of a page by name."""

    def __init__(self) -> None:
        super().__init__()
        self.charts: dict[str, Any] = {}

    def add_figure(self, place: str, drawn: Any) -> None:
        """Add a figure, and keep it."""
        super().add_figure(place, drawn)
        self.charts[str(drawn.name)] = drawn


def drawn_charts(runs: Sequence[ChartRun]) -> dict[str, Any]:
    """Return the charts of runs as they are drawn."""
    page = _Kept()
    time_charts(runs, page)
    return page.charts


def loaded_charts(runs: Sequence[ChartRun]) -> dict[str, Any]:
    """Return the charts of runs out of the document of the page, which takes four times longer."""
    from bokeh.document import Document

    page = PageCharts()
    time_charts(runs, page)
    document: Any = page.data['document']
    return {str(chart.name): chart for chart in Document.from_json(document).roots}
