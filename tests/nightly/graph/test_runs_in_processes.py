# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Graphs of many processes leave the bag of the headless loop, for each kind of run."""

from pathlib import Path

import pytest
from support.runs import bag_bytes, expected, plan, record
from support.sensors import ALL_ON

from ddct_bringup.run.plan import RunPlan
from ddct_plant.scenario.choices.settings import ARCHITECTURES
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

SCENARIO = load_scenario('thesis', ['duration_s=0.8', 'reference.reference_end_s=0.75'])


def require_headless(runs: tuple[RunPlan, RunPlan], folder: Path) -> None:
    """Require that two runs, which differ in their layout, leave the same bag."""
    bags = []
    for run in runs:
        recording = record(run, folder / run.layout)
        assert recording.trajectory.sha256() == expected(run).sha256(), run.layout
        bags.append(bag_bytes(folder / run.layout))
    assert bags[0] == bags[1]


@pytest.mark.parametrize('architecture', ARCHITECTURES)
def test_every_architecture_leaves_the_same_bytes(tmp_path: Path, architecture: str) -> None:
    settings = RunSettings(KnownSettings(SCENARIO, architecture), CaseSettings(wear_gain=0.9))
    processes, headless = (
        RunPlan(settings, 'hinf2', layout) for layout in ('processes', 'headless')
    )
    require_headless((processes, headless), tmp_path)


@pytest.mark.parametrize(
    ('controller', 'options'),
    [('pi', {'seed': 2**31 - 1, 'changes': (ALL_ON,)}), ('mpc4', {'scenario': 'thesis_sticking'})],
    ids=['sensors', 'two inputs'],
)
def test_other_kinds_of_runs_leave_the_same_bytes(
    tmp_path: Path, controller: str, options: dict[str, object]
) -> None:
    processes, headless = (
        plan(controller, layout, duration_s=0.7, **options)  # type: ignore[arg-type]
        for layout in ('processes', 'headless')
    )
    require_headless((processes, headless), tmp_path)
