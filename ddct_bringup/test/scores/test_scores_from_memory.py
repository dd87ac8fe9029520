# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A headless run is scored from memory, and its bag gives the same scores to the last bit."""

from pathlib import Path
from typing import Any

import pytest

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.bag.recording import Recording
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores import scored_recording
from ddct_bringup.scores.document import scores_document
from ddct_bringup.scores.scored_recording import run_and_score, score_bag
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

LIMITS = packaged_limits()
SHIFT = {'off_going_wear_gain': 0.9, 'seed': 3}


def plan_of(controller: str, scenario: str, overrides: list[str], **settings: Any) -> RunPlan:
    loaded = load_scenario(scenario, overrides)
    return RunPlan(RunSettings.of(loaded, settings), controller, 'headless')


@pytest.mark.parametrize(
    'plan',
    [
        plan_of('ls8', 'thesis', ['duration_s=2.5'], wear_gain=0.7),
        plan_of(
            'mpc3',
            'launch',
            ['duration_s=1.5', 'sensors.engine_speed.delay_s=0.02'],
        ),
        plan_of('pi', 'upshift', ['duration_s=1.5'], **SHIFT),
        plan_of('pi', 'launch_hill', [], wear_gain=1.3),
    ],
    ids=['worn', 'sensors', 'shift', 'stalled'],
)
def test_a_bag_has_the_scores_of_its_run_in_memory(plan: RunPlan, tmp_path: Path) -> None:
    made = run_and_score(plan, tmp_path, LIMITS)
    read = score_bag(tmp_path, plan.name, LIMITS)
    assert scores_document([made.scores], LIMITS) == scores_document([read.scores], LIMITS)
    assert (made.digest, made.timing) == (read.digest, read.timing)
    assert made.recording is not None and read.recording is not None
    assert made.recording.trajectory.sha256() == read.recording.trajectory.sha256()
    for name in ('path', 'facts', 'custom_data', 'run_info', 'settings', 'absent', 'missed'):
        assert getattr(made.recording, name) == getattr(read.recording, name), name


def test_the_bag_of_a_headless_run_is_not_read_to_score_it(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    read = []
    monkeypatch.setattr(scored_recording, 'read_bag', lambda path: read.append(path))
    run_and_score(plan_of('pi', 'thesis', ['duration_s=1.0']), tmp_path, LIMITS)
    assert read == []


def test_the_bag_of_a_graph_is_read_to_score_it(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    plan = plan_of('pi', 'thesis', ['duration_s=1.0'])
    read = []

    def noted(path: Path) -> Recording:
        read.append(read_bag(path))
        return read[-1]

    monkeypatch.setattr(scored_recording, 'read_bag', noted)

    def as_a_graph(plan: RunPlan, folder: Path) -> None:
        scored_recording.execute(plan, folder)

    scored = run_and_score(plan, tmp_path, LIMITS, as_a_graph)
    assert [scored.recording] == read
