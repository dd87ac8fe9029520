# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Headless programs run where our packages find no more of a system than Windows has."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow.parquet as parquet
import pytest
from support.declared import PACKAGES
from support.elsewhere import elsewhere, python_elsewhere
from support.runs import bag_bytes, plan, record

from ddct_bringup.programs.ddct import main

pytestmark = [pytest.mark.slow, pytest.mark.process]

# As a script of a user: nothing keeps a worker from running it once more.
SCRIPT = """
import importlib, json, pkgutil, sys, time
from ddct_bringup.api import sweep
from ddct_bringup.programs.ddct import main
from ddct_controllers.interface import Command, Controller

print('the script starts')


class Mine(Controller):
    def reset(self):
        self.gain = len(parts)

    def update(self, measurement):
        return Command(-0.1 * self.gain * measurement.slip_error_rpm)


parts = [1]
codes, refused = {}, {}
for line in sys.argv[1].splitlines():
    sys.argv[1:] = line.split()
    codes[line] = main()
swept = sweep([Mine], {'wear_gain': [0.9, 1.1]}, duration=0.3)
for package in ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup'):
    found = importlib.import_module(package)
    for module in pkgutil.walk_packages(found.__path__, f'{package}.'):
        try:
            importlib.import_module(module.name)
        except (ImportError, AttributeError, ValueError) as error:
            refused[module.name] = str(error)
with open('outcome.json', 'w') as file:
    json.dump({'codes': codes, 'refused': refused, 'swept': [*swept['valid']]}, file)
"""
COMPARE = 'compare --controllers pi --headless --duration 2 --out runs'
SPEC = 'controllers: [pi]\nscenario: thesis\ngrid: {wear_gain: [0.9, 1.1], duration_s: [0.3]}\n'
CAMPAIGN = 'campaign wear.yaml --workers 1 --out'
IDENTIFY = 'identify --from runs/pi --hold-out 0.3 --out mycar'
GRAPH = 'compare --controllers pi --out graph'


@dataclass(frozen=True)
class Outcome:
    """What the script has left."""

    place: Path
    printed: str
    complaints: list[str]
    codes: dict[str, int]
    """Exit codes by command."""
    refused: dict[str, str]
    """Reasons by module of ours that could not be imported."""
    swept: list[bool]


@pytest.fixture(scope='module')
def outcome(tmp_path_factory: pytest.TempPathFactory) -> Outcome:
    site, place = elsewhere(tmp_path_factory.mktemp('site')), tmp_path_factory.mktemp('place')
    (place / 'wear.yaml').write_text(SPEC, encoding='utf-8')
    (place / 'script.py').write_text(SCRIPT, encoding='utf-8')
    commands = '\n'.join([COMPARE, f'{CAMPAIGN} campaign', IDENTIFY, GRAPH])
    done = python_elsewhere(site, place, 'script.py', commands)
    assert done.returncode == 0, done.stderr
    found: dict[str, Any] = json.loads((place / 'outcome.json').read_text(encoding='utf-8'))
    return Outcome(place, done.stdout, done.stderr.splitlines(), **found)


def test_programs_end_well_and_the_graph_is_refused_in_one_line(outcome: Outcome) -> None:
    *headless, graph = outcome.codes.values()
    assert (headless, graph) == ([0, 0, 0], 1)
    (line,) = (each for each in outcome.complaints if 'graph' in each)
    assert line == (
        'ddct compare: the graph and its nodes run on Linux alone, and this is win32: run '
        'headless, as with --headless'
    )
    assert not (outcome.place / 'graph').exists()


def test_a_bag_has_the_same_bytes(outcome: Outcome, tmp_path: Path) -> None:
    record(plan('pi', 'headless', duration_s=2.0), tmp_path / 'pi')
    assert bag_bytes(outcome.place / 'runs' / 'pi') == bag_bytes(tmp_path / 'pi')


def test_new_processes_compute_the_rows_that_forks_do(
    outcome: Outcome, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(outcome.place)
    assert main([*CAMPAIGN.split(), 'forked']) == 0
    anew, forked = (
        parquet.read_table(f'{each}/results.parquet') for each in ('campaign', 'forked')
    )
    assert anew.equals(forked)


def test_a_class_of_a_script_runs_in_new_processes_and_the_script_once(outcome: Outcome) -> None:
    assert outcome.swept == [True, True]
    assert outcome.printed.count('the script starts') == 1


def test_a_lock_leaves_no_file(outcome: Outcome) -> None:
    assert [*outcome.place.glob('.*')] == []


def test_only_processes_of_nodes_need_linux(outcome: Outcome) -> None:
    others = [name for name in outcome.refused if '.processes.' not in name]
    assert others == ['ddct_bringup.live.live_node']
    assert {name.partition('.')[0] for name in outcome.refused} < {*PACKAGES}
