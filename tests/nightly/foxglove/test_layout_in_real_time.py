# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""No panel of the Foxglove layout stays empty for a bag that was recorded in real time."""

from pathlib import Path

import pytest
from support.foxglove_layout import problems, read_layout, read_messages
from support.runs import plan

from ddct_bringup.run.execution import execute
from ddct_plant.graph.node_reports import TICKS


def test_no_panel_is_empty_in_a_real_time_bag(tmp_path: Path) -> None:
    execute(plan('pi', 'single-process', mode='realtime', duration_s=0.7), tmp_path)
    bag = read_messages(tmp_path)
    told = {status.name for _, message in bag['/diagnostics'] for status in message.status}
    if told != {f'/driveline{TICKS}'}:
        pytest.skip(f'too busy for real time: {", ".join(sorted(told))}')
    assert problems(read_layout(), bag) == []
