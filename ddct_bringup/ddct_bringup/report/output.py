"""Where a page may go, and what it takes to make one."""

import importlib.util
from pathlib import Path

from ddct_plant.base.errors import DdctError
from ddct_plant.files.output_file import STDOUT, require_place

MARKER = '<meta name="generator" content="ddct_bringup report">'
"""Tells a page that this program wrote, and may replace, from other files."""

_HEAD_BYTES = 1000
"""The marker stands within these."""


def require_chart_library() -> None:
    """Raise DdctError where the package that draws the charts is not installed."""
    if importlib.util.find_spec('bokeh') is None:
        raise DdctError('the report needs the Python package bokeh: pip install bokeh')


def require_writable(out: str) -> None:
    """Raise DdctError where the page cannot go, or would replace what is no page of ours."""
    if out == STDOUT:
        return
    require_place('--out', out)
    path = Path(out)
    try:
        if path.is_file() and path.stat().st_size:
            with path.open('rb') as file:
                ours = MARKER.encode() in file.read(_HEAD_BYTES)
            if not ours:
                raise DdctError(f'--out {out} is a file that is not ours: choose another name')
    except OSError as error:
        raise DdctError(f'--out {out}: cannot be read ({error.strerror})') from error
