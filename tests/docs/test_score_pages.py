# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""README and the pages on scores name what the programs write."""

import re
from pathlib import Path

from support.documented import ROOT

from ddct_bringup.metrics.catalogue import FIGURES, OTHERS
from ddct_bringup.scores.document import run_entry
from ddct_bringup.scores.scoring import run_without_score
from ddct_plant.files.json_records import to_json

USE = ROOT / 'docs' / 'use'


def named(page: Path, heading: str) -> list[str]:
    """Return the names in the first column of the tables below a heading."""
    text = page.read_text(encoding='utf-8').partition(f'\n## {heading}\n')[2]
    rows = re.findall(r'^\| (`.*?) \|', text.partition('\n## ')[0], re.MULTILINE)
    return [name for row in rows for name in re.findall(r'`(\w+)`', row)]


def test_every_figure_is_on_the_page_of_the_verdict() -> None:
    assert named(USE / 'judging.md', 'Figures') == [each.key for each in FIGURES]


def test_every_metric_and_every_other_key_of_a_run_is_on_the_page() -> None:
    page = USE / 'judging.md'
    assert named(page, 'Metrics of scores.json') == [each.key for each in OTHERS]
    others = to_json(run_entry(run_without_score('bag', None, 'why'))).keys() - {'metrics'}
    assert sorted(named(page, 'Other keys of a run')) == sorted(others)
