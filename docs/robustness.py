# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Keep the results of the campaigns of docs/thesis/robustness_map.md, and write its tables."""

import sys

from generator.pages import fill_pages
from generator.robustness.robustness_map import keep
from generator.tables import TABLES

KIND = 'robustness'

if __name__ == '__main__':
    if len(sys.argv) != 3:
        sys.exit('usage: python docs/robustness.py DELAY MASS, the folders of the two campaigns')
    keep(sys.argv[1:])
    fill_pages(KIND, TABLES[KIND]())
