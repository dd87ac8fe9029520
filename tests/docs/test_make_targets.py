# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page on set-up and `make help` have every target that the Makefile has for its users."""

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def targets() -> set[str]:
    """Return the targets that are no files, `help` apart."""
    makefile = (ROOT / 'Makefile').read_text(encoding='utf-8').replace('\\\n', ' ')
    (phony,) = re.findall(r'^\.PHONY:(.*)$', makefile, re.MULTILINE)
    return set(phony.split()) - {'help'}


def test_the_table_of_the_page_has_each_target_once(targets: set[str]) -> None:
    page = (ROOT / 'docs' / 'use' / 'setup.md').read_text(encoding='utf-8')
    described = re.findall(r'^\| `make ([a-z-]+)` \| \S', page, re.MULTILINE)
    assert sorted(described) == sorted(targets)


def test_the_help_of_make_has_each_target_once(targets: set[str]) -> None:
    printed = subprocess.run(
        ['make', '--no-print-directory', '-C', str(ROOT), 'help'],
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    listed = printed.removeprefix('make ').partition(' (see ')[0]
    assert sorted(listed.split(' | ')) == sorted(targets)
