# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every link leads somewhere, every page is found, every example in Python runs."""

import re
import subprocess
import sys

import pytest
from documented_commands import SHELL_BLOCKS
from support.documented import PAGES, ROOT, blocks, links

from ddct_bringup.programs import compare
from ddct_bringup.thesis.table_5_1 import PREDICTED, THESIS_TABLE

pytestmark = pytest.mark.slow

PREDICTED_ROWS = [row.controller for row in THESIS_TABLE if row.use == PREDICTED]
WITHIN_S = 240.0
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
        'docs/use/python.md',
        'docs/controllers/writing_a_controller.md',
        'docs/controllers/controller_files.md',
    ],
)
def test_python_examples_run(page, tmp_path):
    """One after the other, as one reads them."""
    parts = [block.text for block in blocks() if block.page == page and block.language == 'python']
    assert parts
    code = '\n'.join(parts)
    done = subprocess.run(
        [sys.executable, '-c', code],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=WITHIN_S,
        check=False,
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize('page', PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_to_files(page):
    assert [str(target) for target in links(page) if not target.exists()] == []


def test_every_page_is_three_clicks_from_the_top():
    found = {PAGES[0]}
    for _ in range(CLICKS):
        found |= {target for page in found if page.suffix == '.md' for target in links(page)}
    assert [str(page) for page in PAGES if page not in found] == []


def test_the_table_of_the_readme_is_what_make_demo_prints(tmp_path, capsys):
    """
    All but the line that rich draws as wide as its table.

    Below the heading of two lines each controller has a row, a predicted one two with its range.
    """
    makefile = (ROOT / 'Makefile').read_text(encoding='utf-8')
    (names,) = re.findall(r'compare \\\n\s+--controllers (\S+) --out runs/demo', makefile)
    assert compare.main(['--controllers', names, '--headless', '--out', str(tmp_path / 'x')]) == 0
    printed = {' '.join(line.split()) for line in capsys.readouterr().out.splitlines()}
    (table,) = [block for block in blocks() if block.page == 'README.md' and 't_a' in block.text]
    shown = [line for line in table.lines if '─' not in line]
    assert len(shown) == 2 + sum(2 if name in PREDICTED_ROWS else 1 for name in names.split(','))
    assert [line for line in shown if line not in printed] == []
