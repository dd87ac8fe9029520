# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Take the picture of a report for the README: python -m report.picture PAGE PICTURE.png."""

import io
import sys
from pathlib import Path

from PIL import Image
from report.headless_chromium import PICTURE, visit

WIDTH_PX, HEIGHT_PX = 1280, 9000
"""Size of the window in pixels, high enough that nothing scrolls while the picture is taken."""
BOTTOM = """Math.ceil(
  document.querySelector('#signals figure').getBoundingClientRect().bottom + scrollY)"""


def main() -> None:
    """Take the summary and the first row of charts."""
    page, target = sys.argv[1:]
    seen = visit(Path(page), width=WIDTH_PX, height=HEIGHT_PX, scripts=[BOTTOM, PICTURE])
    whole = Image.open(io.BytesIO(seen.values[1])).convert('RGB')
    picture = whole.crop((0, 0, whole.width, seen.values[0]))
    picture.quantize(256).save(target, optimize=True)


if __name__ == '__main__':
    main()
