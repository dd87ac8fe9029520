# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The wait for a line of the live view leaves the processor to others between two looks."""

from types import SimpleNamespace
from typing import Any

import pytest

from ddct_bringup.processes import live_process
from ddct_bringup.processes.live_process import LiveView
from ddct_bringup.processes.supervisor import POLL_S


def test_the_wait_for_a_line_sleeps_between_two_looks(monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[object] = []
    printed = iter(['', 'ws://', 'ws:// a viewer shows'])

    def printed_text() -> str:
        done.append('look')
        return next(printed)

    view: Any = SimpleNamespace(printed_text=printed_text, _require_running=lambda: None)
    monkeypatch.setattr(live_process, 'time', SimpleNamespace(sleep=done.append))
    LiveView._wait_for(view, 'a viewer shows')
    assert done == ['look', POLL_S, 'look', POLL_S, 'look']
