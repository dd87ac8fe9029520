# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The graph follows the scenario's engine speed and pedal as the headless run does."""

from pathlib import Path

import numpy as np
import pytest
from samples import sampled
from support.runs import expected, plan, record


@pytest.mark.parametrize(
    ('controller', 'changes'),
    sampled(
        [
            ('decoupled_pid', ('engine_authority.slew_n_m_s=800.0',)),
            (
                'torque_estimator',
                (
                    'engine_speed_reference.time_s=[0.6, 1.0]',
                    'engine_speed_reference.speed_rad_s=[241.0, 255.0]',
                ),
            ),
            ('pedal_mpc', ('pedal_position=1.0',)),
            (
                'mpc_preview',
                (
                    'reference.shape=engine_speed_target',
                    'engine_speed_reference.time_s=[0.0]',
                    'engine_speed_reference.speed_rad_s=[210.0]',
                ),
            ),
        ],
        every=2,
    ),
)
def test_the_graph_leaves_the_headless_trajectory(
    tmp_path: Path, controller: str, changes: tuple[str, ...]
) -> None:
    run = plan(controller, 'single-process', changes=changes)
    trajectory = record(run, tmp_path / 'run').trajectory
    assert trajectory.sha256() == expected(run).sha256()
    moved = np.ptp(trajectory.engine_torque - trajectory.torque_demand) > 10.0
    assert moved == (controller in ('decoupled_pid', 'torque_estimator'))
