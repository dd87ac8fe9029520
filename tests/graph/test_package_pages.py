# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page of each package names the topics and parameters of its nodes, as they declare them."""

import re
from pathlib import Path

import pytest
from support.documented import ROOT
from support.runs import plan

from ddct_plant.base.options import options_of
from ddct_plant.program.scheduling import Scheduling
from ddct_plant.scenario.settings import RunSettings

PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
SHARED = {'scenario', *options_of(RunSettings), *options_of(Scheduling)}
OF_ROS = {'/rosout', '/parameter_events', '/run_info'}
WITH_TARGET = (
    'reference.shape=engine_speed_target',
    'engine_speed_reference={time_s: [0.0, 2.0], speed_rad_s: [160.0, 180.0]}',
)
SHIFT = plan('pi', scenario='upshift', duration_s=2.0, clutch='stick_slip')
RUNS = (
    plan('pi'),
    plan('pi', clutch='stick_slip', changes=('sensors={}',)),
    plan('mpc4'),
    plan('pi', mode='realtime'),
    plan('pi', changes=WITH_TARGET),
    plan('pi', changes=(*WITH_TARGET, 'sensors={}')),
    SHIFT,
    plan('mpc4', scenario='upshift', duration_s=2.0, clutch='stick_slip', changes=('sensors={}',)),
)
"""Runs that have every topic between them."""


def page(package: str) -> str:
    return (ROOT / package / 'README.md').read_text(encoding='utf-8')


@pytest.mark.parametrize('package', PACKAGES)
def test_the_example_without_ros_runs(package: str, capsys: pytest.CaptureFixture[str]) -> None:
    (example,) = re.findall(r'```python\n(.*?)```', page(package), re.DOTALL)
    exec(compile(example, f'{package}/README.md', 'exec'), {})
    assert re.search(r'-?\d+\.\d', capsys.readouterr().out)


@pytest.mark.parametrize('package', PACKAGES)
@pytest.mark.parametrize('name', ['README.md', 'CHANGELOG.md'])
def test_each_link_of_a_package_page_leads_to_a_file(package: str, name: str) -> None:
    file = ROOT / package / name
    links = re.findall(r'\]\(([^)#]+)[^)]*\)', file.read_text(encoding='utf-8'))
    assert links
    assert [link for link in links if not Path(file.parent, link).is_file()] == []
