# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Topics are named in one table: no other module spells them, and the interfaces page agrees."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from syntax import tree_of

from ddct_plant.graph import node_reports
from ddct_plant.signals import topics
from ddct_plant.signals.topic import Topic
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
PAGE = (ROOT / 'docs' / 'develop' / 'graph.md').read_text(encoding='utf-8')


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


def rows() -> dict[str, list[str]]:
    """Return by topic the cells of its row on the page: type, publisher, frame, content."""
    table = PAGE.partition('## Topics\n')[2].partition('\n\n')[0]
    lines = [line.strip('| ').split(' | ', 4) for line in table.splitlines()[2:]]
    return {name.strip('`'): cells for name, *cells in lines}


def test_the_page_has_a_row_for_each_topic_in_the_order_of_the_table() -> None:
    assert list(rows()) == [topic.name for topic in TOPICS]


@pytest.mark.parametrize('topic', TOPICS, ids=lambda topic: topic.name)
def test_the_row_of_a_topic_agrees_with_the_table(topic: Topic) -> None:
    kind, publisher, frame, content = rows()[topic.name]
    assert kind == topic.type.replace('/msg/', '/')
    assert publisher == topic.publisher
    assert frame == (topic.frame or '-')
    for signal in topic.signals:
        unit = signal.unit.replace('^2', '²')
        assert re.search(rf'\b{unit}(?!\S*[/²])', content), f'{signal.name} in {unit}'
    assert ('latched' in content) == topic.latched
    assert ('wall clock' in content) == topic.wall_clock
    assert ('only with' in content) == (topic.when is not None)
