# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every bad value on a topic ends the node that reads it, with the topic and the stamp."""

import pytest
from support.bad_values import CASES, require_named
from support.in_process_graph import GraphOf


@pytest.mark.parametrize('case', CASES)
def test_a_bad_value_ends_its_reader_with_topic_and_stamp(graph_of: GraphOf, case: str) -> None:
    require_named(graph_of, case)
