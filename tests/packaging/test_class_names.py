# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""No two classes of the packages have the same name: a reader finds each by its name alone."""

import ast
from pathlib import Path

from syntax import tree_of

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')


def classes(package: str) -> list[tuple[str, str]]:
    """Return the name of each class of a package, with its file in the repository."""
    return [
        (node.name, str(file.relative_to(ROOT)))
        for file in sorted((ROOT / package / package).rglob('*.py'))
        for node in ast.walk(tree_of(file))
        if isinstance(node, ast.ClassDef)
    ]


def test_no_class_name_occurs_twice() -> None:
    found: dict[str, list[str]] = {}
    for package in PACKAGES:
        for name, file in classes(package):
            found.setdefault(name, []).append(file)
    assert {'Plant', 'ScenarioFile'} <= found.keys()
    assert {name: files for name, files in found.items() if len(files) > 1} == {}
