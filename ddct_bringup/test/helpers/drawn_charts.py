# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time charts of a page, as its script loads them."""

from collections.abc import Sequence
from typing import Any

from ddct_bringup.documents.bokeh_charts import PageCharts
from ddct_bringup.report.chart_marks import ChartRun
from ddct_bringup.report.charts import time_charts


def drawn_charts(runs: Sequence[ChartRun]) -> dict[str, Any]:
    """Return the charts of runs by name."""
    from bokeh.document import Document

    page = PageCharts()
    time_charts(runs, page)
    document: Any = page.data['document']
    return {str(chart.name): chart for chart in Document.from_json(document).roots}
