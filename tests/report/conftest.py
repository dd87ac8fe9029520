# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Headless runs of the thesis's scenario, and their report page."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from report.headless_chromium import Browser, Visitor
from support.runs import plan, record

from ddct_bringup.programs.report import main
from ddct_bringup.report import front_view
from ddct_bringup.report.evidence import FREQUENCY_FILE
from ddct_controllers.workflows.evidence import frequency_evidence
from ddct_plant.files.json_records import write_json
from ddct_plant.scenario.file import scenario_digest

CONTROLLERS = ('pi', 'ls8', 'hinf1')


@pytest.fixture(scope='session')
def demo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with one complete run per controller, and their frequency evidence."""
    folder = tmp_path_factory.mktemp('runs') / 'demo'
    for name in CONTROLLERS:
        record(plan(name, 'headless', duration_s=3.0), folder / name)
    settings = plan(duration_s=3.0).settings
    evidence = frequency_evidence(CONTROLLERS, settings)
    conditions = replace(evidence.conditions, scenario_digest=scenario_digest(settings.scenario))
    write_json(str(folder / FREQUENCY_FILE), replace(evidence, conditions=conditions))
    return folder


@pytest.fixture(scope='session', autouse=True)
def few_points_of_the_front() -> Iterator[None]:
    """Draw the front through two points beside the runs: each takes half a second to compute."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(front_view, '_POINTS', 2)
        yield


@pytest.fixture(scope='session')
def page(demo: Path) -> Path:
    """Return the report over `demo`."""
    out = demo.parent / 'report.html'
    assert main([str(demo), '--out', str(out)]) == 0
    return out


@pytest.fixture(scope='module')
def visit() -> Iterator[Visitor]:
    """Return a function that opens a page in the one browser of the tests of a file."""
    with Browser() as browser:
        yield browser.visit
