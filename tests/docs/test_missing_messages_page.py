# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page on missing messages has every node, and the times of the code."""

from generator.missing_tables import missing_tables
from generator.pages import DOCS, as_markdown, shown_tables

from ddct_bringup.processes.graph_nodes import NODE_PROGRAMS

PAGE = (DOCS / 'use' / 'live.md').read_text(encoding='utf-8')


def test_the_tables_are_those_of_the_code() -> None:
    assert shown_tables('missing') == as_markdown(missing_tables()), 'run: make docs KINDS=missing'


def test_every_node_of_the_graph_is_in_the_table_of_real_time() -> None:
    nodes = ' '.join(row[0] for row in missing_tables()['realtime'].rows)
    assert [spec.name for spec in NODE_PROGRAMS if f'`{spec.name}`' not in nodes] == []
