# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The table of README is what its demo prints, and the longer examples in Python run."""

import re
from pathlib import Path

from support.documented import ROOT, blocks, run_examples

from ddct_bringup.programs import compare
from ddct_bringup.thesis.table_5_1 import PREDICTED, THESIS_TABLE

PREDICTED_ROWS = [row.controller for row in THESIS_TABLE if row.use == PREDICTED]


def test_the_table_of_the_readme_is_what_make_demo_prints(tmp_path, capsys):
    """A controller has a row below the heading of three lines, a predicted one two."""
    makefile = (ROOT / 'Makefile').read_text(encoding='utf-8')
    (names,) = re.findall(r'compare \\\n\s+--controllers (\S+) --out runs/demo', makefile)
    assert compare.main(['--controllers', names, '--headless', '--out', str(tmp_path / 'x')]) == 0
    printed = {' '.join(line.split()) for line in capsys.readouterr().out.splitlines()}
    (table,) = [block for block in blocks() if block.page == 'README.md' and 't_a' in block.text]
    shown = table.lines
    assert len(shown) == 3 + sum(2 if name in PREDICTED_ROWS else 1 for name in names.split(','))
    assert [line for line in shown if line not in printed] == []


def test_the_examples_of_the_python_interface_run(tmp_path: Path) -> None:
    run_examples('docs/use/python.md', tmp_path)
