# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Figures of `scores.json` equal those that an independent script computes from the bag."""

import ast
import sys
from pathlib import Path
from typing import Any

import pytest
import support
from support.independent_figures import Figure, independent_figures

from ddct_bringup.api import Run, run
from ddct_bringup.metrics.metric import finite
from ddct_bringup.scores.scoring import engagement_of
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import EngineCommand

CASES: dict[str, tuple[str, dict[str, Any]]] = {
    'linear': ('pi', {'scenario': 'thesis'}),
    'launch': ('ls8', {'scenario': 'launch', 'wear_gain': 0.8}),
    'two inputs': ('torque_estimator', {'scenario': 'launch'}),
    'parted': ('pi', {'scenario': 'tip_in', 'wear_gain': 0.7}),
    'shift': ('mpc3', {'scenario': 'upshift', 'wear_gain': 1.2}),
    'stalled': ('hinf1', {'scenario': 'launch_hill', 'wear_gain': 1.3}),
}


@pytest.fixture(scope='module', params=CASES)
def made(request, tmp_path_factory) -> Run:
    """Return a run of each kind, with its bag."""
    controller, options = CASES[request.param]
    return run(controller, out=tmp_path_factory.mktemp('bags'), **options)


@pytest.fixture(scope='module')
def found(made: Run) -> dict[str, Figure]:
    """Return the figures that the independent script computes from that bag."""
    return independent_figures(made.path)


def agree(found: float | None, expected: float | None) -> bool:
    """Return whether both are equal to 1e-9, or both have no value."""
    if found is None or expected is None:
        return found is expected
    return found == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_every_figure_of_a_run_is_that_of_the_independent_script(made, found):
    ours = {
        key: value
        for key, value in made.figures.items()
        if key not in ('peak_jerk_over_least', 'least_is_bound')  # those are of the floor
    }
    assert {*ours} == {*found} - {'withheld_s', 'added_s', 'delivered_at_end'}
    for key, value in ours.items():
        assert agree(found[key], value), (key, found[key], value)


def test_what_a_controller_does_with_the_demand_is_that_of_the_independent_script(made, found):
    engagement = engagement_of(made.recording, None)
    command = EngineCommand.of(engagement, packaged_limits().rules)
    keys = ('withheld_s', 'added_s', 'delivered_at_end')
    if command is None:
        assert all(found[key] is None for key in keys)
        return
    for key, value in zip(keys, command, strict=True):
        assert agree(found[key], finite(value)), key


def test_the_script_imports_nothing_of_the_packages():
    folder = Path(support.__file__).parent
    for name in ('independent_bag.py', 'independent_figures.py'):
        tree = ast.parse((folder / name).read_text(encoding='utf-8'))
        imported = {
            each.module if isinstance(each, ast.ImportFrom) else alias.name
            for each in ast.walk(tree)
            if isinstance(each, ast.Import | ast.ImportFrom)
            for alias in each.names
        }
        tops = {module.partition('.')[0] for module in imported} - sys.stdlib_module_names
        assert tops <= {'mcap', 'mcap_ros2', 'numpy', 'scipy', 'support', 'yaml'}
