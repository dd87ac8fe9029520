# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The frequency-domain evidence is of the simulated loop, and `compare` writes it to a file."""

import dataclasses
import json

import numpy as np
import pytest
from drawn_charts import leave_out_time_charts
from drawn_here import draw_here
from linear_controllers import LINEAR
from samples import sampled

from ddct_bringup.programs import compare
from ddct_bringup.report.evidence import FREQUENCY_FILE
from ddct_bringup.run.headless import run_headless
from ddct_controllers.design.analysis.loops import sampled_loop
from ddct_controllers.design.analysis.step_response import step_response
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.registry import make_controller
from ddct_controllers.workflows.evidence import frequency_evidence
from ddct_plant.base.units import rad_s_from_rpm, rpm_from_rad_s
from ddct_plant.files.json_records import to_json
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

pytestmark = pytest.mark.slow

STEP_RPM = 1.0
AT_STEP = 100
"""Step index of the step of the error, after control start at 0.6 s; 200 steps and more follow."""
SCENARIO = load_scenario('thesis')


class SteppedError(Controller):
    """
    A controller whose slip error is raised by `step_rpm` from `AT_STEP` on.

    For the feedback that is a step of the reference, but a filter of the reference does not get
    it.
    """

    def __init__(self, inner: Controller, step_rpm: float) -> None:
        self._inner, self._step = inner, rad_s_from_rpm(step_rpm)
        self.preview_steps = inner.preview_steps

    def reset(self) -> None:
        self._inner.reset()

    def update(self, measurement: Measurement) -> Command:
        if measurement.step >= AT_STEP:
            lowered = measurement.engine_speed - self._step
            measurement = dataclasses.replace(measurement, engine_speed=lowered)
        return self._inner.update(measurement)


@pytest.mark.parametrize('wear_gain', sampled([0.7, 1.0, 1.3], every=3))
@pytest.mark.parametrize('name', LINEAR)
def test_a_small_step_of_the_slip_error_has_the_response_of_the_sampled_loop(name, wear_gain):
    """
    The change of w_d between two complete runs is within 1e-3 of its peak.

    It depends on the sampling, the delay, the wear gain, every sign and unit.
    """
    require_run_as_the_loop(
        name, RunSettings(KnownSettings(SCENARIO), CaseSettings(wear_gain=wear_gain))
    )


def require_run_as_the_loop(name: str, settings: RunSettings) -> None:
    without, stepped = (
        run_headless(settings, SteppedError(make_controller(name, settings.known), step_rpm))
        for step_rpm in (0.0, STEP_RPM)
    )
    change = stepped.slip_speed[AT_STEP:] - without.slip_speed[AT_STEP:]
    found = rpm_from_rad_s(change) / STEP_RPM
    model = make_controller(name, settings.known).linear_model()
    scenario = settings.scenario
    loop = sampled_loop(model, scenario.driveline, settings.case.wear_gain, scenario.actuator)
    _, expected = step_response(loop, 0.01 * (len(found) - 1))
    assert found == pytest.approx(expected, abs=1e-3 * np.abs(expected).max())


@pytest.mark.parametrize('delay_s', [0.0, 0.013, 0.04])
def test_the_sampled_loop_has_the_actuator_of_the_run(delay_s):
    changes = [f'actuator.delay_s={delay_s}', 'actuator.bandwidth_factor=0.8']
    require_run_as_the_loop('ls8', RunSettings(KnownSettings(load_scenario('thesis', changes))))


def test_compare_leaves_the_evidence_beside_the_scores(tmp_path, monkeypatch):
    draw_here(monkeypatch)
    leave_out_time_charts(monkeypatch)
    out = tmp_path / 'out'
    options = ['--wear-gain', '0.8', '--floors', 'none', '--headless', '--out', str(out)]
    assert compare.main(['--controllers', 'ls8,pi', *options]) == 0
    document = json.loads((out / FREQUENCY_FILE).read_text(encoding='utf-8'))
    assert document['conditions']['delay_s'] == 0.01
    assert [entry['controller'] for entry in document['controllers']] == ['ls8', 'pi']
    for entry in document['controllers']:
        assert entry['linear']
        assert [point['wear_gain'] for point in entry['wear']] == [0.7, 0.8, 1.0, 1.3]
        assert entry['nominal']['stable']


@pytest.mark.parametrize('name', ['mpc3', 'mpc4'])
def test_a_predictive_controller_has_no_frequency_response(name):
    (entry,) = frequency_evidence([name], RunSettings(KnownSettings(SCENARIO))).controllers
    assert to_json(entry) == {
        'controller': name,
        'linear': False,
        **dict.fromkeys(('nominal', 'stable_wear_gain', 'wear', 'corners')),
    }
