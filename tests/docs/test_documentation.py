# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every link leads somewhere, every page is found, every example in Python runs."""

import subprocess

import pytest
from support.documented import PAGES, ROOT, blocks, links, run_examples
from support.documented_commands import SHELL_BLOCKS

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.spec import read_spec

pytestmark = pytest.mark.slow

CLICKS = 3


def test_commands_in_shell_blocks_begin_with_ddct_or_a_path():
    """A bare program name works in no shell, and would slip through the tests of commands."""
    names = {'bringup', 'compare', 'score', 'report', 'live', 'reproduce', 'design', 'identify'}
    bare = [
        (block.page, line)
        for block in blocks()
        for line in block.lines
        if line.split()[0] in names and block.language == ''
    ]
    assert bare == []


def test_there_are_commands_to_run():
    assert len(SHELL_BLOCKS) > 15
    assert {block.page for block in SHELL_BLOCKS} >= {'README.md', 'docs/controllers/mpc.md'}


@pytest.mark.parametrize(
    'page',
    [
        'README.md',
        'docs/controllers/writing_a_controller.md',
        pytest.param('docs/controllers/controller_files.md', marks=pytest.mark.nightly),
    ],
)
def test_python_examples_run(page, tmp_path):
    """Those of docs/use/python.md take longer: `tests/nightly/docs` runs them."""
    run_examples(page, tmp_path)


def test_links_lead_to_files():
    lost = {str(page): [each for each in links(page) if not each.exists()] for page in PAGES}
    assert {page: targets for page, targets in lost.items() if targets} == {}


def test_every_page_is_three_clicks_from_the_top():
    found = {PAGES[0]}
    for _ in range(CLICKS):
        found |= {target for page in found if page.suffix == '.md' for target in links(page)}
    assert [str(page) for page in PAGES if page not in found] == []


@pytest.mark.parametrize('path', sorted((ROOT / 'docs' / 'examples').glob('robustness_*.yaml')))
def test_the_specifications_of_the_robustness_map_can_be_run(path):
    campaign = Campaign(read_spec(path))
    settings = campaign.run(campaign.runs - 1).settings
    assert campaign.runs > 1000 and settings.scenario.name == 'thesis'


def test_the_diff_that_adds_a_metric_fits_the_code():
    """`tests/nightly/docs` tries what it gives."""
    page = (ROOT / 'CONTRIBUTING.md').read_text(encoding='utf-8')
    diff = page.partition('\n### A metric\n')[2].partition('```diff\n')[2].partition('```')[0]
    command = ['git', 'apply', '--check', '-']
    done = subprocess.run(command, input=diff, text=True, cwd=ROOT, check=False)
    assert diff and done.returncode == 0
