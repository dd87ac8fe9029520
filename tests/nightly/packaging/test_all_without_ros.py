# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Without ROS, with what the packages require of PyPI and no more, all but the graph works."""

import json
from dataclasses import dataclass
from pathlib import Path

import pytest
from support.declared import PACKAGES, ROS
from support.runs import bag_bytes, plan, record
from support.without_ros import fill_site, python

ALL = """
import contextlib, importlib, io, json, pkgutil, sys
from ddct_bringup.programs import compare, thesis, score
from ddct_controllers.workflows import design_program
from ddct_bringup.identification import identify
from ddct_plant.base.errors import DdctError
codes, refused = {}, {}
for name, main, arguments in (
    ('compare', compare.main, '--controllers pi --headless --duration 1 --out runs'),
    ('score', score.main, 'runs --json scores.json'),
    ('identify', identify.main, ''),
    ('design', design_program.main, 'margins --controllers pi'),
    ('thesis', thesis.main, 'numbers --help'),
):
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        try:
            codes[name] = main(arguments.split())
        except SystemExit as end:
            codes[name] = end.code
for package in sys.argv[1:]:
    found = importlib.import_module(package)
    for module in pkgutil.walk_packages(found.__path__, f'{package}.', lambda name: None):
        try:
            importlib.import_module(module.name)
        except ImportError as error:
            refused[module.name] = error.name
        except DdctError as error:  # an extra is missing: the line says how to install it
            refused[module.name] = error.__cause__.name
print(json.dumps({'codes': codes, 'refused': refused}))
"""
"""Runs each program, and tries to import each module."""


@pytest.fixture(scope='module')
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return fill_site(tmp_path_factory.mktemp('site'))


@dataclass(frozen=True)
class Outcome:
    """Results of a run of ALL: its folder, exit codes and failed imports."""

    place: Path
    codes: dict[str, int]
    """Exit codes by program."""
    refused: dict[str, str]
    """Missing module, by the module of ours that needs it."""


@pytest.fixture(scope='module')
def outcome(site: Path, tmp_path_factory: pytest.TempPathFactory) -> Outcome:
    """Run all that can run without ROS."""
    place = tmp_path_factory.mktemp('place')
    done = python(site, place, '-c', ALL, *PACKAGES)
    assert done.returncode == 0, done.stderr
    return Outcome(place, **json.loads(done.stdout))


def test_the_programs_end_well(outcome: Outcome) -> None:
    assert set(outcome.codes.values()) == {0}, outcome.codes
    scores = json.loads((outcome.place / 'scores.json').read_text(encoding='utf-8'))
    assert [run['valid'] for run in scores['runs']] == [True]
    assert (outcome.place / 'runs' / 'report.html').stat().st_size > 100_000


def test_a_bag_has_the_same_bytes_as_that_of_the_graph(outcome: Outcome, tmp_path: Path) -> None:
    pytest.importorskip('rclpy', reason='a graph')
    record(plan('pi', 'single-process'), tmp_path / 'pi')
    assert bag_bytes(outcome.place / 'runs' / 'pi') == bag_bytes(tmp_path / 'pi')


def test_only_nodes_and_what_they_share_need_ros(outcome: Outcome) -> None:
    assert outcome.refused['ddct_bringup.gym'] == 'gymnasium'  # an extra
    assert set(outcome.refused.values()) <= {*ROS, 'gymnasium'}
    others = [
        name
        for name in outcome.refused
        if not name.startswith('ddct_plant.graph.') and not name.endswith('_node')
    ]
    assert sorted(others) == [
        'ddct_bringup.gym',
        'ddct_bringup.processes.single_process',
        'ddct_bringup.record.parameters',
        'ddct_bringup.record.recorded_bag',
        'ddct_plant.nodes.tick_plan',
    ]
