# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Topics are named in one table: no other module spells them."""

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from syntax import tree_of

from ddct_plant.graph import node_reports
from ddct_plant.signals import topics
from ddct_plant.signals.topics import TOPICS

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
OWNERS: dict[Any, Path] = {
    **{
        name: Path(topics.__file__).resolve()
        for topic in TOPICS
        for name in (topic.name, topic.resolved_name)
    },
    node_reports.TICKS: Path(node_reports.__file__).resolve(),
    node_reports.SAFE_STATE: Path(node_reports.__file__).resolve(),
}
"""File that spells each name of a topic or of a status."""


def product_files() -> Iterator[Path]:
    for package in PACKAGES:
        yield from (ROOT / package / package).rglob('*.py')


def test_no_name_of_a_topic_is_spelled_outside_the_table() -> None:
    spelled = [
        f'{file.relative_to(ROOT)}:{node.lineno}: {node.value!r}'
        for file in product_files()
        for node in ast.walk(tree_of(file))
        if isinstance(node, ast.Constant) and OWNERS.get(node.value, file) != file
    ]
    assert spelled == []


def test_no_two_entries_have_the_same_name_or_signal() -> None:
    signals = [signal.name for signal in topics.all_signals()]
    assert len({topic.name for topic in TOPICS}) == len(TOPICS)
    assert len(set(signals)) == len(signals)
