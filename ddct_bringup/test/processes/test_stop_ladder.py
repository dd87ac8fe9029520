# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time that a node has to end after each signal, by a clock that only waits advance."""

import signal
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from ddct_bringup.processes import node_processes
from ddct_bringup.processes.node_processes import NodeProcesses


def test_a_node_has_ten_seconds_to_end_by_itself_and_five_to_be_terminated(monkeypatch):
    now_s = 0.0
    signals = []

    def sleep(duration_s):
        nonlocal now_s
        now_s += duration_s

    clock = SimpleNamespace(monotonic=lambda: now_s, sleep=sleep)
    monkeypatch.setattr(node_processes, 'time', clock)
    deaf: Any = SimpleNamespace(
        name='load',
        running=True,
        send=lambda number: signals.append((number, round(now_s, 1))),
        check=lambda elapsed_s: None,
    )
    nodes = NodeProcesses(Path(), Path(), None)
    nodes._nodes = [deaf]
    nodes.stop(lambda name: True)
    assert signals == [(signal.SIGINT, 0.0), (signal.SIGTERM, 10.0), (signal.SIGKILL, 15.0)]
    assert now_s == pytest.approx(17.0, abs=0.1)
