# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page docs/use/verdict.md agrees with the code and the packaged limits."""

import re
from pathlib import Path

from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import STATES

PAGE = (Path(__file__).resolve().parents[3] / 'docs' / 'use' / 'verdict.md').read_text(
    encoding='utf-8'
)


def rows(heading):
    """Return the cells of the rows of the table below a heading."""
    section = PAGE.partition(f'\n## {heading}\n')[2].partition('\n## ')[0]
    lines = [line for line in section.splitlines() if line.startswith('| ')][1:]
    return [[cell.strip() for cell in line.strip('|').split('|')] for line in lines]


def test_every_state_is_on_the_page():
    assert [name for row in rows('States') for name in re.findall('`(.*?)`', row[0])] == list(
        STATES
    )


def test_the_thresholds_of_the_text_are_those_of_the_file():
    rules = packaged_limits().rules
    states = PAGE.partition('\n## States\n')[2].partition('\n## ')[0]
    for text in (
        f'within {rules.engaged_slip:g} rpm for {rules.settled_time:g} s',
        f'more than {rules.runaway_slip:g} rpm',
        f'keeps within {rules.locked_slip:g} rpm for {rules.settled_time:g} s',
        f'reaches {rules.runaway_swing:g} times what was reached before',
        f'grows by {rules.runaway_growth:g} rpm/s',
        f'its limiter in the last {rules.settled_time:g} s',
        f'each time by {2 * rules.engaged_slip:g} rpm or more',
    ):
        assert text in states
    assert f'takes {rules.engagements_a_day:g} engagements a day' in PAGE
