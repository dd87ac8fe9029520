# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A file next to the bags is used only where the page can show all of it."""

import dataclasses
import json

import pytest
from made_scores import made_scores
from test_report_escaping import SETTINGS, recording

from ddct_bringup.report import evidence
from ddct_bringup.report.evidence import COMPUTED, FREQUENCY_FILE, LoopEvidence, loop_rows
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_controllers.workflows.evidence import actuator_conditions, frequency_evidence
from ddct_plant.files.json_records import json_text, to_json
from ddct_plant.scenario.file import load_scenario, scenario_digest
from ddct_plant.scenario.settings import KnownSettings, RunSettings


@pytest.fixture(scope='module')
def run():
    return recording('x')


@pytest.fixture(scope='module')
def whole():
    return frequency_evidence(['pi'], SETTINGS)


@pytest.fixture
def remark(tmp_path, monkeypatch, whole, run):
    """Return a function that returns the source of the evidence for a bag."""
    monkeypatch.setattr(evidence, 'frequency_evidence', lambda names, settings: whole)
    found = dataclasses.replace(run, path=tmp_path / 'pi' / 'pi_0.mcap')

    def read(text: str, settings: RunSettings = SETTINGS) -> str:
        (tmp_path / FREQUENCY_FILE).write_text(text, encoding='utf-8')
        recorded = dataclasses.replace(found, settings=settings)
        (loop,) = evidence.evidence_of([ScoredRecording(made_scores('pi'), recorded)])
        assert len(loop_rows([loop])) == 1
        return loop.remark

    return read


def test_loop_values_are_those_of_the_run_s_own_wear_gain(whole):
    (entry,) = whole.controllers
    for wear_gain in (0.7, 1.0, 1.3):
        assert LoopEvidence('pi', wear_gain, entry).point.wear_gain == wear_gain
    assert LoopEvidence('pi', 0.85, entry).point is None


def test_whole_evidence_is_taken(remark, whole):
    assert remark(json_text(whole)) == ''


@pytest.mark.parametrize('change', ['actuator.delay_s=0.05', 'actuator.bandwidth_factor=0.5'])
def test_evidence_for_another_actuator_is_computed_anew(remark, whole, change):
    slow = RunSettings(KnownSettings(load_scenario('thesis', [change])))
    digest = scenario_digest(slow.scenario)
    conditions = dataclasses.replace(whole.conditions, scenario_digest=digest)
    assert remark(json_text(dataclasses.replace(whole, conditions=conditions)), slow) == COMPUTED
    own = dataclasses.replace(conditions, actuator=actuator_conditions(slow.scenario.actuator))
    assert remark(json_text(dataclasses.replace(whole, conditions=own)), slow) == ''


@pytest.mark.parametrize(
    ('path', 'value'),
    [
        (('controllers', 0), 3),
        (('controllers', 0, 'linear'), 'yes'),
        (('controllers', 0, 'linear'), False),
        (('controllers', 0, 'wear'), None),
        (('controllers', 0, 'wear'), [1, 'x', {}]),
        (('controllers', 0, 'wear', 1, 'gain_margin_db'), '\x1b[31m'),
        (('controllers', 0, 'wear', 1, 'stable'), 'yes'),
        (('controllers', 0, 'wear', 1, 'crossover_rad_s'), [1]),
        (('controllers', 0, 'stable_wear_gain'), 'all'),
        (('controllers', 0, 'stable_wear_gain', 'lowest'), 'none'),
        (('controllers', 0, 'corners'), None),
        (('controllers', 0, 'corners', 'unstable_corners'), '</script>'),
        (('controllers',), {}),
        (('conditions',), []),
    ],
)
def test_evidence_of_another_shape_is_computed_anew(remark, whole, path, value):
    content = to_json(whole)
    target = content
    for key in path[:-1]:
        target = target[key]
    target[path[-1]] = value
    assert remark(json.dumps(content)) == COMPUTED


@pytest.mark.parametrize('text', ['', '[1]', '{"controllers": 1, "controllers": 2}'])
def test_a_file_that_is_no_evidence_counts_as_none(remark, text):
    assert remark(text) == COMPUTED
