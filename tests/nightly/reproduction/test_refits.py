# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Refits of the calibration, from where it is and from elsewhere, and by its program."""

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest

from ddct_bringup.programs import reproduce
from ddct_bringup.reproduction.calibration import command
from ddct_bringup.reproduction.calibration.parameters import RANGE, values_of
from ddct_bringup.reproduction.calibration.problem import Problem, fit
from ddct_plant.scenario.control import ReferenceParameters
from ddct_plant.scenario.file import load_scenario

SCENARIO = load_scenario('thesis')
PROBLEM = Problem(SCENARIO.score_window_s[1])
VALUES = np.array(values_of(SCENARIO))
DOCS = Path(__file__).resolve().parents[3] / 'docs'
RECORD = json.loads((DOCS / 'thesis' / 'calibration.json').read_text(encoding='utf-8'))


def test_fit_from_a_displaced_start_returns_to_the_frozen_scenario():
    start = VALUES + np.array([0.0, -30.0, -0.02, 12.0, 0.03, 0.02])
    change = (np.array(fit(PROBLEM, start).values) - VALUES) / RANGE
    assert np.max(np.abs(change[2:])) < 0.01
    assert abs(change[1] - change[0] * RANGE[0] / RANGE[1]) < 0.01


def test_quick_check_of_the_frozen_scenario_passes_and_shows_fit_residuals(capsys, tmp_path):
    assert reproduce.main(['calibration', '--quick', '--json', str(tmp_path / 'check.json')]) == 0
    output = capsys.readouterr()
    assert 'not reproductions' in output.out
    assert 'local refit' in output.err
    residuals = json.loads((tmp_path / 'check.json').read_text())['residuals']
    assert [row['computed'] for row in residuals] == pytest.approx(
        [row['computed'] for row in RECORD['residuals']], rel=1e-6
    )


def test_quick_check_fails_for_a_scenario_that_is_not_the_optimum(monkeypatch, capsys):
    scenario = load_scenario('thesis')
    other = dataclasses.replace(
        scenario, reference=ReferenceParameters(scenario.reference.slope_rad_s2 + 5.0)
    )
    monkeypatch.setattr(command, 'load_scenario', lambda name: other)
    assert reproduce.main(['calibration', '--quick']) == 1
    errors = capsys.readouterr().err.splitlines()
    assert errors[-1].startswith('ddct reproduce: scenario thesis is not the optimum')
