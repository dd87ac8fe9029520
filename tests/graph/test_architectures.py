# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Every architecture is one loop: the graph in one process and headless agree to the last bit.

That of many processes is in tests/nightly.
"""

from pathlib import Path

import pytest
from samples import sampled
from support.runs import LAYOUTS, bag_bytes, expected, record

from ddct_bringup.run.plan import RunPlan
from ddct_plant.scenario.choices.settings import ARCHITECTURES
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

pytestmark = pytest.mark.slow

SCENARIO = load_scenario('thesis', ['duration_s=0.8', 'reference.reference_end_s=0.75'])


@pytest.mark.parametrize('architecture', sampled(ARCHITECTURES, every=3))
def test_both_layouts_leave_the_same_bytes_and_the_headless_trajectory(
    tmp_path: Path, architecture: str
) -> None:
    bags = []
    for layout in LAYOUTS[1:]:
        run = RunPlan(
            RunSettings(KnownSettings(SCENARIO, architecture), CaseSettings(wear_gain=0.9)),
            'hinf2',
            layout,
        )
        recording = record(run, tmp_path / layout)
        assert recording.trajectory.sha256() == expected(run).sha256(), layout
        bags.append(bag_bytes(tmp_path / layout))
    assert bags[0] == bags[1]


@pytest.mark.parametrize('name', sampled(['launch', 'tip_in'], every=2))
@pytest.mark.parametrize(
    'architecture', sampled([name for name in ARCHITECTURES if name != 'detailed'], every=3)
)
def test_a_clutch_that_sticks_has_the_same_stored_reference_in_the_graph_and_headless(
    tmp_path: Path, architecture: str, name: str
) -> None:
    scenario = load_scenario(name, ['duration_s=0.6', 'score_window_s=[0.3,0.6]'])
    run = RunPlan(RunSettings(KnownSettings(scenario, architecture)), 'hinf2', 'single-process')
    assert record(run, tmp_path / name).trajectory.sha256() == expected(run).sha256()
