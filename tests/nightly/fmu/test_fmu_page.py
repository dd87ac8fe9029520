# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The examples of the page on FMUs work as printed there."""

import json
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from support.documented import ROOT, blocks
from support.fmu import write_fmu

from ddct_bringup.programs import compare
from ddct_controllers.registry import controller_spec

PAGE = 'docs/controllers/files.md'
BLOCKS = [block for block in blocks() if block.page == PAGE]
LINES = [line for block in BLOCKS for line in block.lines]
COMPARISONS = [line for line in LINES if line.startswith('ddct compare') and 'mine.yaml' in line]
PYTHON = '.venv/bin/python '
FMPY = '.venv/bin/fmpy '


@pytest.fixture
def template(folder: Path) -> str:
    (text,) = [
        block.text for block in BLOCKS if block.language == 'yaml' and 'fmu:\n' in block.text
    ]
    Path('mine.yaml').write_text(text, encoding='utf-8')
    return 'mine.yaml'


def test_its_template_and_commands_run(template: str, folder: Path) -> None:
    (make_one,) = [line for line in LINES if line.startswith(PYTHON)]
    (look,) = [line for line in LINES if line.startswith(f'{FMPY}info')]
    for python, line in (([], make_one), (['-m', 'fmpy'], look)):
        words = shlex.split(line)[1:]
        words[0] = str(ROOT / words[0]) if not python else words[0]
        done = subprocess.run([sys.executable, *python, *words], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
    assert 'rev/min' in done.stdout
    first, _ = COMPARISONS
    assert compare.main(shlex.split(first.removeprefix('ddct compare '))) == 0
    pi, mine = json.loads((folder / 'runs' / 'mine' / 'scores.json').read_text())['runs']
    assert (pi['controller'], mine['controller']) == ('pi', 'mine')
    assert mine['valid']


def test_the_option_that_it_changes_is_one(template: str) -> None:
    write_fmu(Path('mine.fmu'), 3)
    changed = shlex.split(COMPARISONS[1])
    key = changed[changed.index('--set') + 1].partition('=')[0]
    assert key.removeprefix('controllers.mine.') in (controller_spec(template).options or {})
