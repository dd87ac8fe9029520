# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`compare` writes the report next to the bags, with the evidence of the same runs."""

import json
from importlib.resources import files
from pathlib import Path

from ddct_bringup.programs.compare import main
from ddct_bringup.verdict.limits import load_limits


def test_compare_ends_with_the_report(tmp_path: Path) -> None:
    out = tmp_path / 'demo'
    limits = tmp_path / 'mine.yaml'
    limits.write_bytes((files('ddct_bringup.verdict') / 'limits.yaml').read_bytes())
    arguments = ['--controllers', 'pi,ls8', '--headless', '--limits', str(limits)]
    arguments += ['--floors', 'none']
    assert main([*arguments, '--out', str(out)]) == 0
    page = (out / 'report.html').read_text(encoding='utf-8')
    assert '<title>Clutch engagement, thesis: pi, ls8</title>' in page
    assert 'Computed for this page' not in page
    assert 'Judged by the limits <b>mine.yaml</b>' in page
    scores = json.loads((out / 'scores.json').read_text(encoding='utf-8'))
    assert scores['limits'] == load_limits(limits).origin
