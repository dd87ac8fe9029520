# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Each source file names its licence and who holds the copyright."""

import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCES = ('*.py', '*.c', '*.h', '*.js', '*.mjs', '*.css')
GIVEN_AWAY = 'c_library/template/my_controller.c'
"""The user fills this file in, so it is under the licence that the user chooses."""


def sources() -> list[str]:
    """Return the source files of the repository, as git lists them."""
    listed = subprocess.run(
        ['git', 'ls-files', *SOURCES], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if listed.returncode:
        pytest.skip('this is no clone: git does not list the sources')
    return [name for name in listed.stdout.splitlines() if not name.endswith(GIVEN_AWAY)]


@pytest.mark.process
def test_every_source_file_begins_with_its_copyright_and_licence() -> None:
    without = [
        name
        for name in sources()
        if 'Copyright 2026 DDCT team' not in (head := (ROOT / name).read_text()[:200])
        or 'SPDX-License-Identifier: Apache-2.0' not in head
    ]
    assert not without
