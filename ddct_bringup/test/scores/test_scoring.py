# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Validity and state of a run that its engine ended."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from made_run import made_facts

from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.scored_recording import score_recording
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.models.engine_limits import EngineLimits
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
TRAJECTORY = run_headless(SETTINGS, 'ls8')
FACTS = made_facts()


FULL_LOAD = (0.0, 110.0, 170.0, 225.0, 250.0, 217.0, 165.0, 308.0)
ENGINE_LIMITS = EngineLimits(stall_rad_s=52.0, over_rev_rad_s=785.0, full_load_n_m=FULL_LOAD)


def scored(last_engine_speed, rows=301, engine_limits=ENGINE_LIMITS, **signals):
    """Return the scores of a run that ends after `rows` samples at this engine speed."""
    cut = {name: value[:rows] for name, value in {**TRAJECTORY.signals, **signals}.items()}
    speeds = cut['joint_speed'].copy()
    speeds[-1, 0] = last_engine_speed
    trajectory = Trajectory({**cut, 'joint_speed': speeds})
    scenario = dataclasses.replace(SETTINGS.scenario, engine_limits=engine_limits)
    settings = RunSettings(dataclasses.replace(SETTINGS.known, scenario=scenario))
    recording = Recording(Path('x.mcap'), trajectory, FACTS, settings=settings)
    return score_recording(recording, 'x', packaged_limits()).scores


@pytest.mark.parametrize(
    ('speed', 'state'), [(52.0, 'stalled'), (10.0, 'stalled'), (785.0, 'over_revved')]
)
def test_a_run_that_its_engine_ended_is_valid_and_has_that_as_its_state(speed, state):
    run = scored(speed, rows=100)
    assert (run.valid, run.reason) == (True, '')
    assert run.state == state
    assert run.metrics['torsion_speed_std_rpm'] is None


def test_an_early_end_without_a_cause_is_not_valid():
    for run in (scored(200.0, rows=100), scored(10.0, rows=100, engine_limits=None)):
        assert (run.valid, run.state) == (False, 'invalid')
        assert run.reason == 'ended early: 99 of 300 steps'


def test_a_stall_with_a_value_that_is_not_finite_is_not_valid():
    accelerations = TRAJECTORY.vehicle_accel.copy()
    accelerations[50] = np.inf
    run = scored(10.0, rows=100, vehicle_accel=accelerations)
    assert (run.valid, run.state) == (False, 'invalid')


def test_a_whole_run_of_a_good_controller_is_engaged():
    run = scored(TRAJECTORY.joint_speed[-1, 0])
    assert (run.valid, run.state) == (True, 'engaged')
    assert run.why == ''


def test_the_facts_of_the_run_are_those_of_the_bag():
    run = scored(200.0)
    assert run.facts == FACTS


def test_steps_without_a_solution_count_where_feedback_is_off_at_the_end():
    off = (('feedback', 'held off'),)
    counts = [(('feedback', 'on'), ('fallbacks', count)) for count in '0122']
    status = (off, *counts, *[off] * 296)
    assert scored(200.0, status=status).fallbacks == 2
    assert scored(200.0, status=(off,) * 301).fallbacks is None
