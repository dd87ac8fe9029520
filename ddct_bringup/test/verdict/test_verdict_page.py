# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page docs/use/judging.md agrees with the code and the packaged limits."""

import re
from pathlib import Path

from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import STATES

PAGE = (Path(__file__).resolve().parents[3] / 'docs' / 'use' / 'judging.md').read_text(
    encoding='utf-8'
)


def state_rows():
    """Return the text of each row of the table of states by the names in its first cell."""
    section = PAGE.partition('\n## States\n')[2].partition('\n## ')[0]
    rows = [line.strip('| ').split(' | ') for line in section.splitlines() if line[:3] == '| `']
    return {tuple(re.findall('`(.*?)`', names)): text for names, text in rows}


def test_every_state_is_on_the_page():
    named = [name for names in state_rows() for name in names]
    assert sorted(named) == sorted(STATES)


def test_the_thresholds_of_the_states_are_those_of_the_file():
    rules, rows = packaged_limits().rules, state_rows()
    for state, text in (
        ('tied_up', f'more than {rules.tie_up_work_j:g} J'),
        (
            'not_engaged',
            f'within {rules.engaged_slip:g} rpm over the last {rules.settled_time:g} s',
        ),
        ('flared', f'more than {rules.flare_rad_s:g} rad/s'),
        ('late', f'less than {rules.locked_time:g} s'),
        ('withheld', f'more than {rules.withheld_time:g} s'),
        (
            'withheld',
            f'less than {rules.delivered_share:g} of it over the last {rules.delivered_time:g} s',
        ),
        ('added', f'more than {rules.added_time:g} s'),
    ):
        assert text in rows[(state,)], state
