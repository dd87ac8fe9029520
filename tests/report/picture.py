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
BETWEEN_PX = 16
PLACES = """['#figures details', '#signals', '#signals figure'].map((name) => {
  const {top, bottom} = document.querySelector(name).getBoundingClientRect();
  return [Math.floor(top + scrollY), Math.ceil(bottom + scrollY)];
})"""


def main() -> None:
    """Put the summary and the first row of charts below each other."""
    page, target = sys.argv[1:]
    seen = visit(Path(page), width=WIDTH_PX, height=HEIGHT_PX, scripts=[PLACES, PICTURE])
    (further, _), (signals, _), (_, charts) = seen.values[0]
    whole = Image.open(io.BytesIO(seen.values[1])).convert('RGB')
    parts = [
        whole.crop((0, top, whole.width, bottom))
        for top, bottom in ((0, further), (signals - BETWEEN_PX, charts))
    ]
    picture = Image.new('RGB', (whole.width, sum(part.height for part in parts)), 'white')
    picture.paste(parts[0], (0, 0))
    picture.paste(parts[1], (0, parts[0].height))
    picture.quantize(256).save(target, optimize=True)


if __name__ == '__main__':
    main()
