# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Names of the files of a benchmark; cheap to import."""

RESULT, PAGE = 'result.json', 'report.html'
