# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A page with one bare Bokeh chart, drawn by the same browser as a report."""

from pathlib import Path

import numpy as np
from bokeh.embed import file_html
from bokeh.plotting import figure
from bokeh.resources import INLINE

_POINTS = 300
_READY = """<script>
(async () => {
  const frame = () => new Promise(requestAnimationFrame);
  while (!(window.Bokeh && Bokeh.documents.length && Bokeh.documents[0].is_idle)) await frame();
  await frame();
  window.reportReady = performance.now();
})();
</script></body>"""


def write_bare_chart(page: Path, lines: int) -> None:
    """Write a page with one chart of `lines` lines, each with the points of a run of 3 s."""
    chart = figure(width=900, height=300)
    x = np.linspace(0.0, 3.0, _POINTS)
    for line in range(lines):
        chart.line(x, np.sin(x + line))
    html = file_html(chart, INLINE, 'bare chart')
    page.write_text(html.replace('</body>', _READY), encoding='utf-8')
