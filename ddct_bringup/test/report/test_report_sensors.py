# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page shows whether controllers read sensors, which ones, and the sensor errors."""

from pathlib import Path

import pytest
from drawn_charts import leave_out_time_charts

from ddct_bringup.bag.realtime_facts import RealtimeFacts
from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.report.page import report_page
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_bringup.scores.scoring import score_run
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

CHART = 'Slip speed as measured, less the true one'


@pytest.fixture(autouse=True)
def no_time_charts(monkeypatch: pytest.MonkeyPatch) -> None:
    """test_report_charts.py is about what they draw; their titles stay on the page."""
    leave_out_time_charts(monkeypatch)


def page(*changes: str) -> str:
    """Return the report of a short run of `pi`."""
    given = ['duration_s=0.7', 'score_window_s=[0.1,0.6]', *changes]
    settings = RunSettings(KnownSettings(load_scenario('thesis', given)))
    recording = Recording(
        path=Path('/nowhere/pi_0.mcap'),
        trajectory=run_headless(settings, 'pi'),
        facts=RunFacts.of(settings, 'pi', settings.scenario.steps),
        settings=settings,
        run_info={},
        missed={},
        realtime=RealtimeFacts(),
    )
    scores = score_run(recording, 'pi', packaged_limits(), None)
    return report_page([ScoredRecording(scores, recording)], [], packaged_limits())


def test_sensors_are_named_and_have_their_chart():
    html = page('sensors.engine_speed.noise_rad_s=0.25', 'sensors.engine_torque.gain=1.05')
    words = 'engine_speed: noise_rad_s 0.25 rad/s; engine_torque: gain 1.05.'
    assert f'Controller and reference read <b>sensors</b>: {words}' in html
    assert CHART in html


def test_a_run_without_sensors_has_neither():
    html = page()
    assert 'sensors</b>' not in html
    assert CHART not in html
