# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""README and the pages on scores name what the programs write."""

import re
from pathlib import Path

from support.documented import ROOT

from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.scores.document import run_entry
from ddct_bringup.scores.scoring import run_without_score
from ddct_bringup.verdict.state import STATES
from ddct_bringup.verdict.verdict import BEYOND, FAILED, NO_LIMIT, UNAVOIDABLE, WITHIN

WORDS = (BEYOND, WITHIN, UNAVOIDABLE, NO_LIMIT, FAILED)

USE = ROOT / 'docs' / 'use'


def named(page: Path, heading: str) -> list[str]:
    """Return the names in the first column of the tables below a heading."""
    text = page.read_text(encoding='utf-8').partition(f'\n## {heading}\n')[2]
    rows = re.findall(r'^\| (`.*?) \|', text.partition('\n## ')[0], re.MULTILINE)
    return [name for row in rows for name in re.findall(r'`(\w+)`', row)]


def test_every_metric_and_every_other_key_of_a_run_is_on_the_page() -> None:
    page = USE / 'metrics_and_symbols.md'
    assert sorted(named(page, 'Metrics of scores.json')) == sorted(METRICS)
    others = run_entry(run_without_score('bag', None, 'why')).keys() - {'metrics'}
    assert sorted(named(page, 'Other keys of a run')) == sorted(others)


def test_every_state_and_every_word_on_limits_is_on_the_page() -> None:
    page = USE / 'metrics_and_symbols.md'
    assert named(page, 'States') == list(STATES)
    assert sorted(named(page, 'Words on limits')) == sorted(WORDS)
