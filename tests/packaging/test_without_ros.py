# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Without ROS, with what the packages require of PyPI and no more, all but the graph works."""

import importlib.metadata
import json
import os
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from support.runs import bag_bytes, plan, record
from test_dependencies import PACKAGES, ROOT, ROS, declared_to_pip

from ddct_plant.program.command_line import package_version

FIND_ROS = f'import importlib.util as u; print([n for n in {sorted(ROS)} if u.find_spec(n)])'
ALL = """
import contextlib, importlib, io, json, pkgutil, sys
from ddct_bringup.programs import compare, reproduce, score
from ddct_controllers.workflows import design_program
from ddct_plant.identification import identify
codes, refused = {}, {}
for name, main, arguments in (
    ('compare', compare.main, '--controllers pi --headless --duration 1 --out runs'),
    ('score', score.main, 'runs --json scores.json'),
    ('identify', identify.main, ''),
    ('design', design_program.main, 'margins --controller pi'),
    ('reproduce', reproduce.main, 'numbers --help'),
):
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        try:
            codes[name] = main(arguments.split())
        except SystemExit as end:
            codes[name] = end.code
for package in sys.argv[1:]:
    found = importlib.import_module(package)
    for module in pkgutil.walk_packages(found.__path__, f'{package}.'):
        try:
            importlib.import_module(module.name)
        except ImportError as error:
            refused[module.name] = error.name
print(json.dumps({'codes': codes, 'refused': refused}))
"""
"""Runs each program, and tries to import each module."""

pytestmark = pytest.mark.slow


def required(names: Iterable[str]) -> set[str]:
    """Return the distributions and what they require in turn, without extras."""
    found: set[str] = set()
    todo = list(names)
    while todo:
        name = todo.pop()
        if name not in found:
            found.add(name)
            needs = map(Requirement, importlib.metadata.requires(name) or ())
            todo += [n.name for n in needs if not n.marker or n.marker.evaluate({'extra': ''})]
    return found


@pytest.fixture(scope='module')
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder of packages as pip would fill it for the four of ours."""
    folder = tmp_path_factory.mktemp('site')
    declared = {each for package in PACKAGES for each in declared_to_pip(package)[0]}
    for name in required({each for each in declared if not each.startswith(PACKAGES)}):
        distribution = importlib.metadata.distribution(name)
        if distribution.files is None:
            pytest.skip(f'{name} has no list of files: it was not installed by pip')
        for top in {file.parts[0] for file in distribution.files} - {'..', '__pycache__'}:
            link = folder / top
            if not link.exists():
                link.symlink_to(str(distribution.locate_file(top)))
    for package in PACKAGES:
        (folder / package).symlink_to(ROOT / package / package)
        metadata = folder / f'{package}-{package_version()}.dist-info'
        metadata.mkdir()
        text = f'Metadata-Version: 2.1\nName: {package}\nVersion: {package_version()}\n'
        (metadata / 'METADATA').write_text(text, encoding='utf-8')
    return folder


def python(site: Path, place: Path, *arguments: str) -> 'subprocess.CompletedProcess[str]':
    """Run Python where only the site's packages are installed."""
    environment = {
        key: value
        for key, value in os.environ.items()
        if not key.startswith(('AMENT', 'COLCON', 'ROS', '_ROS', 'PYTHON', 'LD_LIBRARY'))
    }
    return subprocess.run(
        [sys.executable, '-S', *arguments],
        cwd=place,
        env={**environment, 'PYTHONPATH': str(site)},
        capture_output=True,
        text=True,
        timeout=300.0,
        check=False,
    )


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


def test_ros_is_not_there(site: Path, tmp_path: Path) -> None:
    assert python(site, tmp_path, '-c', FIND_ROS).stdout == '[]\n'


def test_the_programs_end_well(outcome: Outcome) -> None:
    assert set(outcome.codes.values()) == {0}, outcome.codes
    scores = json.loads((outcome.place / 'scores.json').read_text(encoding='utf-8'))
    assert [run['valid'] for run in scores['runs']] == [True]
    assert (outcome.place / 'runs' / 'report.html').stat().st_size > 100_000


@pytest.mark.graph
def test_a_bag_has_the_same_bytes_as_that_of_the_graph(outcome: Outcome, tmp_path: Path) -> None:
    pytest.importorskip('rclpy', reason='a graph')
    record(plan('pi', 'single-process'), tmp_path / 'pi')
    assert bag_bytes(outcome.place / 'runs' / 'pi') == bag_bytes(tmp_path / 'pi')


def test_only_nodes_and_what_they_share_need_ros(outcome: Outcome) -> None:
    assert set(outcome.refused.values()) <= ROS
    others = [
        name
        for name in outcome.refused
        if not name.startswith('ddct_plant.graph.') and not name.endswith('_node')
    ]
    assert others == [
        'ddct_bringup.processes.single_process',
        'ddct_bringup.programs.live',
        'ddct_bringup.record.parameters',
        'ddct_bringup.record.recorded_bag',
    ]


def test_a_graph_without_ros_ends_with_one_line_that_names_rclpy(
    site: Path, tmp_path: Path
) -> None:
    done = python(site, tmp_path, '-m', 'ddct_bringup.programs.bringup', '--out', 'runs')
    assert done.returncode == 1
    assert done.stdout == ''
    (line,) = done.stderr.splitlines()
    assert 'rclpy is not installed' in line
    assert 'headless' in line
    assert not (tmp_path / 'runs').exists()
