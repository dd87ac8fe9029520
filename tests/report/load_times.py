# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Measure how long a browser takes to draw all of a report: python -m report.load_times PAGE..."""

import statistics
import sys
from pathlib import Path

from report.headless_chromium import visit

REPEATS = 5


def main() -> None:
    """Print size and load time of each page on the command line."""
    for name in sys.argv[1:]:
        page = Path(name)
        times = [visit(page).ready_ms for _ in range(REPEATS)]
        print(
            f'{name}: {page.stat().st_size / 1e6:.2f} MB, drawn after '
            f'{statistics.median(times):.0f} ms ({min(times):.0f} to {max(times):.0f})'
        )


if __name__ == '__main__':
    main()
