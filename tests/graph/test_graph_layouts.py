# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""One run, three layouts: separate processes, a single process and headless leave one bag."""

import gc
from pathlib import Path

import pytest
from support.runs import LAYOUTS, bag_bytes, expected, plan, record


@pytest.mark.parametrize(
    ('controller', 'wear_gain', 'changes', 'layouts'),
    [
        ('ls8', 1.0, (), (*LAYOUTS, 'processes')),
        pytest.param(
            *('pi', 0.7, ('load.slope_rad=0.05', 'actuator.delay_s=0.013'), LAYOUTS[1:]),
            marks=pytest.mark.nightly,
        ),
    ],
    ids=['repeated', 'worn clutch, later actuator, uphill'],
)
def test_every_layout_leaves_the_same_bytes_and_the_headless_trajectory(
    tmp_path: Path,
    controller: str,
    wear_gain: float,
    changes: tuple[str, ...],
    layouts: tuple[str, ...],
) -> None:
    bags = []
    for number, layout in enumerate(layouts):
        run = plan(controller, layout, wear_gain=wear_gain, changes=changes)
        folder = tmp_path / str(number)
        recording = record(run, folder)
        assert recording.trajectory.sha256() == expected(run).sha256(), layout
        bags.append(bag_bytes(folder))
    assert all(bag == bags[0] for bag in bags)


def test_a_repeated_run_in_one_process_leaves_the_same_bytes_and_its_garbage_collector(
    tmp_path: Path,
) -> None:
    run = plan('pi', 'single-process')
    collector = gc.isenabled(), gc.get_threshold()
    bags = []
    for number in range(2):
        record(run, tmp_path / str(number))
        bags.append(bag_bytes(tmp_path / str(number)))
        assert (gc.isenabled(), gc.get_threshold()) == collector
        assert gc.get_freeze_count() > 0, 'what the suite has frozen stays so'
    assert bags[0] == bags[1]


def test_one_last_bit_changes_the_hash() -> None:
    run = plan()
    first, second = expected(run), expected(run)
    assert first.sha256() == second.sha256()
    second.clutch_torque[50, 5] *= 1.0 + 2.0**-52
    assert first.sha256() != second.sha256()
