# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Syntax trees of sources, which the tests of one process share."""

import ast
from functools import cache
from pathlib import Path


@cache
def tree_of(file: Path) -> ast.Module:
    """Return the syntax tree of a source, which is not to be changed."""
    return ast.parse(file.read_text(encoding='utf-8'))
