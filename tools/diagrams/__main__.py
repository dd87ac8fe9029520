# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Draw the diagrams of the pages into docs/images, a second.

    tools/run diagrams
"""

from pathlib import Path

from diagrams.block_diagrams import drawings

IMAGES = Path(__file__).resolve().parents[2] / 'docs' / 'images'

if __name__ == '__main__':
    for file, drawing in drawings().items():
        (IMAGES / file).write_text(drawing, encoding='utf-8')
