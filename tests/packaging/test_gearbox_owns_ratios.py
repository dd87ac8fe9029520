# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The gearbox owns ratios: no other module reads a total ratio or a published one."""

import ast
from pathlib import Path

from syntax import tree_of

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
RATIOS = {'total_ratio', 'ratios', 'final_drives'}
OWNER = 'ddct_plant/ddct_plant/models/gearbox.py'
KEYS = {
    'ddct_plant/ddct_plant/models/parameters.py': {'total_ratio'},
    'ddct_bringup/ddct_bringup/bag/measured_keys.py': {'total_ratio'},
}
"""
Modules that declare a key of files, and what they read of it to make a gear or its range.

One writes the number into a program in C, which has no gearbox.
"""


def _read(file: Path) -> set[str]:
    tree = tree_of(file)
    return {
        node.attr
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and node.attr in RATIOS
    }


def test_only_the_gearbox_and_the_keys_of_files_read_a_ratio() -> None:
    files = [file for one in PACKAGES for file in (ROOT / one / one).rglob('*.py')]
    readers = {str(file.relative_to(ROOT)): _read(file) for file in files}
    assert readers.pop(OWNER) == RATIOS
    assert {file: names for file, names in readers.items() if names} == KEYS
