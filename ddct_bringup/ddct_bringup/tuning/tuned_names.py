# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Names of the files of a tuning; cheap to import."""

FRONT_FOLDER, BEST = 'front', 'best.yaml'
RESULT, PAGE = 'front.json', 'report.html'
