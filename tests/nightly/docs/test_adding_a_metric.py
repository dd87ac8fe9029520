# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The diff in CONTRIBUTING.md that adds a metric is all that a new metric needs."""

import json
import os
import re
import shutil
import subprocess
import sys
from importlib.resources import files
from pathlib import Path
from textwrap import dedent

import pytest
import yaml
from support.documented import ROOT

from ddct_bringup.api import run
from ddct_bringup.scores.document import scores_document
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.files.json_records import write_json

KEY = 'slip_peak_rpm'


@pytest.fixture(scope='module')
def patched(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a copy of the package with the diff, below a folder with scores of the code here."""
    folder = tmp_path_factory.mktemp('metric')
    shutil.copytree(ROOT / 'ddct_bringup' / 'ddct_bringup', folder / 'ddct_bringup/ddct_bringup')
    page = (ROOT / 'CONTRIBUTING.md').read_text(encoding='utf-8')
    section = page.partition('\n### A metric\n')[2]
    diff = re.findall(r'^```diff\n(.*?)^```$', section, re.MULTILINE | re.DOTALL)[0]
    subprocess.run(['git', 'apply', '-'], input=diff, text=True, cwd=folder, check=True)
    before = [run('pi', out=folder / 'before').scores]
    document = scores_document(before, packaged_limits())
    write_json(str(folder / 'scores.json'), document)
    return folder


def limits_with_it() -> str:
    """Return the packaged limits with one of the metric."""
    packaged = (files('ddct_bringup.verdict') / 'limits.yaml').read_text(encoding='utf-8')
    keys = {'metric': KEY, 'value': 500.0, 'unit': 'rpm', 'applies_to': 'all'}
    content = yaml.safe_load(packaged)
    content['limits'].append({**keys, 'convention': True, 'reason': 'a trial'})
    return yaml.safe_dump(content)


def with_metric(folder: Path, script: str) -> str:
    """Return the output of a script that runs with the copy of the package."""
    path = f'{folder / "ddct_bringup"}:{os.environ.get("PYTHONPATH", "")}'
    done = subprocess.run(
        [sys.executable, '-c', dedent(script)],
        cwd=folder,
        env={**os.environ, 'PYTHONPATH': path},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_scores_and_limits_have_it(patched: Path) -> None:
    (patched / 'limits.yaml').write_text(limits_with_it(), encoding='utf-8')
    with_metric(
        patched,
        """
        import json, sys
        from ddct_bringup.programs.score import main
        main(['before/pi', '--json', 'after.json', '--limits', 'limits.yaml'])
        """,
    )
    (after,) = json.loads((patched / 'after.json').read_text(encoding='utf-8'))['runs']
    (beside,) = (each for each in after['limits'] if each['name'] == KEY)
    assert after['metrics'][KEY] == beside['value'] > 1.0
    assert (beside['unit'], beside['limit']) == ('rpm', 500.0)
    before = json.loads((patched / 'scores.json').read_text(encoding='utf-8'))['runs'][0]
    assert before['metrics'] == {key: after['metrics'][key] for key in before['metrics']}


def test_a_batch_has_the_value_of_each_single_run(patched: Path) -> None:
    with_metric(
        patched,
        f"""
        from ddct_bringup.batch.run_batch import run_batch
        from ddct_bringup.campaign.rows import scored_headless
        from ddct_bringup.verdict.limits import packaged_limits
        from ddct_controllers.registry import make_controller
        from ddct_plant.scenario.file import load_scenario
        from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

        scenario = load_scenario('thesis')
        settings = [
            RunSettings(KnownSettings(scenario), CaseSettings(wear_gain=wear))
            for wear in (0.7, 1.0)
        ]
        runs = [(each, make_controller('pi', each.known)) for each in settings]
        for each, found in zip(settings, run_batch(runs, packaged_limits())):
            alone = scored_headless(each, 'pi', packaged_limits()).metrics['{KEY}']
            assert abs(found.metrics['{KEY}'] / alone - 1.0) < 1e-9
        """,
    )


def test_campaigns_sweeps_report_and_pages_have_it(patched: Path) -> None:
    with_metric(
        patched,
        f"""
        import sys
        sys.path.insert(0, {str(ROOT / 'docs')!r})
        from ddct_bringup.api.shell.sweeps import metrics_called
        from ddct_bringup.campaign.columns import runs_table, schema_over
        from ddct_bringup.campaign.rows import SERIAL, ScoredRow, scored_headless
        from ddct_bringup.evaluation.quantities import QUANTITIES
        from ddct_bringup.metrics.catalogue import METRICS
        from ddct_bringup.report.definitions import ShownParts, definitions
        from ddct_bringup.run.run_base import RunBase
        from ddct_bringup.verdict.limits import packaged_limits
        from ddct_plant.scenario.file import ScenarioFile
        from website.tables.score_tables import score_tables

        settings = RunBase(ScenarioFile.read('thesis'), {{}}, {{}}, ()).at()
        scores = scored_headless(settings, 'pi', packaged_limits())
        run = ScoredRow(0, 'pi', 0, {{}}, scores, SERIAL)
        (row,) = runs_table(schema_over({{}}), [run]).to_pylist()
        assert row['{KEY}'] > 1.0
        assert '{KEY}' in QUANTITIES
        assert [each.key for each in metrics_called('--metrics', '{KEY}')] == ['{KEY}']
        shown = ShownParts((), list(METRICS.values()), frozenset(), frozenset())
        found = definitions(shown)
        assert 'peak w_d' in [each.term for group in found.values() for each in group]
        assert '`{KEY}`' in [row[0] for row in score_tables()['metrics'].rows]
        """,
    )


def test_scores_of_before_it_stay_readable(patched: Path) -> None:
    with_metric(
        patched,
        f"""
        from ddct_bringup.api import read_scores

        (run,) = read_scores('scores.json')
        assert run.metrics['{KEY}'] is None and run.metrics['steps'] == 300
        """,
    )
