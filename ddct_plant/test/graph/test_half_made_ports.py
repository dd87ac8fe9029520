# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A port in shared memory whose maker was killed is removed; others stay."""

import struct
from pathlib import Path
from types import SimpleNamespace

import pytest

from ddct_plant.graph import half_made_ports
from ddct_plant.graph.half_made_ports import LEAST_AGE_S, remove_half_made_ports

STATES = {'empty': b'', 'not begun': bytes(64), 'begun': struct.pack('=I60x', 1)}
COMPLETE = struct.pack('=I60x', 2)


def clock(age_s: float, port: Path, sleeps: list[float]) -> SimpleNamespace:
    """Return a clock at this age in s of a file; time goes on while one sleeps."""
    start = port.stat().st_mtime + age_s
    return SimpleNamespace(time=lambda: start + sum(sleeps), sleep=sleeps.append)


@pytest.mark.parametrize('content', STATES.values(), ids=STATES)
def test_an_old_port_that_is_not_complete_is_removed_and_a_complete_one_of_a_dead_owner_stays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, content: bytes
) -> None:
    monkeypatch.setattr(half_made_ports, 'SHARED_MEMORY', tmp_path)
    # Domain 64 has the ports 23400 to 23649, and all domains have those from 7000 to 7399.
    half_made = [tmp_path / f'fastrtps_port{number}' for number in (23400, 23649, 7000, 7399)]
    others = [tmp_path / f'fastrtps_port{number}' for number in (23650, 23399, 6999, 7400)]
    complete = tmp_path / 'fastrtps_port23411'
    complete.write_bytes(COMPLETE)
    for port in (*half_made, *others):
        port.write_bytes(content)
    sleeps: list[float] = []
    now = clock(LEAST_AGE_S, half_made[-1], sleeps)
    monkeypatch.setattr(half_made_ports, 'time', now)
    remove_half_made_ports(64)
    assert sorted(tmp_path.iterdir()) == sorted((complete, *others))
    assert sum(sleeps) < 0.1


def test_a_port_that_is_being_made_has_time_to_become_complete(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(half_made_ports, 'SHARED_MEMORY', tmp_path)
    port = tmp_path / 'fastrtps_port7411'
    port.write_bytes(STATES['begun'])
    sleeps: list[float] = []
    now = clock(0.5 * LEAST_AGE_S, port, sleeps)

    def sleep(time_s: float) -> None:
        sleeps.append(time_s)
        if len(sleeps) == 3:
            port.write_bytes(COMPLETE)

    monkeypatch.setattr(half_made_ports, 'time', SimpleNamespace(time=now.time, sleep=sleep))
    remove_half_made_ports(0)
    assert port.read_bytes() == COMPLETE
    assert len(sleeps) == 3


def test_no_shared_memory_is_no_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(half_made_ports, 'SHARED_MEMORY', tmp_path / 'none')
    remove_half_made_ports(0)
