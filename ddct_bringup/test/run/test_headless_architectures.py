# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The four architectures differ in the closed loop as in Section 1.6 and Chapters 2 and 3."""

import itertools

import numpy as np
import pytest
from samples import sampled

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.reproduction.study_run import thesis_run
from ddct_bringup.run.headless import run_headless
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.registry import controller_names
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.scenario.choices.settings import ARCHITECTURES
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

pytestmark = pytest.mark.slow

SCENARIO = load_scenario('thesis')
START = SCENARIO.control_start_step
ALL_BUT_DETAILED = [name for name in ARCHITECTURES if name != 'detailed']


class NoFeedback(Controller):
    def reset(self) -> None:
        pass

    def update(self, measurement: Measurement) -> Command:
        return Command(0.0)


def run(architecture: str, controller: str, wear_gain: float = 1.0) -> Trajectory:
    return thesis_run(controller, architecture, wear_gain).trajectory


def peak_error_rad_s(trajectory: Trajectory) -> float:
    return float(np.abs(trajectory.slip_reference[:, 0] - trajectory.slip_speed).max())


@pytest.mark.slow
@pytest.mark.parametrize(
    ('name', 'architecture'),
    sampled(itertools.product(controller_names(), ARCHITECTURES), every=5),
)
def test_every_controller_runs_in_every_architecture(architecture, name):
    settings = RunSettings(
        KnownSettings(load_scenario('thesis', ['duration_s=0.8']), architecture)
    )
    trajectory = run_headless(settings, name)
    assert trajectory.steps == 80
    assert np.all(np.isfinite(trajectory.slip_speed))


@pytest.mark.parametrize('wear_gain', [1.0, 0.7])
@pytest.mark.parametrize('architecture', ALL_BUT_DETAILED)
def test_the_reference_is_the_slip_of_the_nominal_detailed_run_to_the_last_bit(
    architecture, wear_gain
):
    reference = run(architecture, 'hinf1', wear_gain).slip_reference[:, 0]
    nominal = run('detailed', 'pi')
    assert nominal.slip_speed[START] > 10.0
    np.testing.assert_array_equal(reference[: START + 1], nominal.slip_speed[: START + 1])
    if architecture != 'feedforward_tanh':
        np.testing.assert_array_equal(reference, nominal.slip_reference[:, 0])


@pytest.mark.parametrize('architecture', ALL_BUT_DETAILED)
def test_feedback_is_on_from_the_start_and_the_clutch_starts_open(architecture):
    trajectory = run(architecture, 'ls8')
    assert dict(trajectory.status[0])['feedback'] == 'on'
    assert trajectory.joint_effort[0, 1] == 0.0
    assert not np.any(trajectory.actuator_torque[0])


@pytest.mark.parametrize(
    ('name', 'most'),
    [('pi', 0.12), ('ls1', 0.15), ('ls8', 0.15), ('hinf1', 0.15), ('hinf2', 0.75)],
)
@pytest.mark.parametrize('architecture', ['feedforward', 'feedforward_tanh'])
def test_feedforward_cuts_the_peak_slip_error_of_the_base(architecture, name, most):
    error = peak_error_rad_s(run(architecture, name))
    assert error < most * peak_error_rad_s(run('base', name))


def test_in_the_base_hinf2_alone_of_its_kind_follows_the_reference():
    errors = {name: peak_error_rad_s(run('base', name)) for name in ('hinf1', 'hinf2', 'hinf3')}
    assert errors['hinf2'] < 15.0
    assert min(errors['hinf1'], errors['hinf3']) > 200.0


def test_hinf2_follows_a_tanh_closer_than_a_ramp_and_with_less_torsion():
    ramp, tanh = (run(name, 'hinf2') for name in ('feedforward', 'feedforward_tanh'))
    assert peak_error_rad_s(tanh) < 0.6 * peak_error_rad_s(ramp)
    ramp_torsion, tanh_torsion = (t.joint_speed[START:170, 3].std() for t in (ramp, tanh))
    assert tanh_torsion < 0.6 * ramp_torsion


def test_feedforward_alone_removes_nearly_all_slip_that_the_static_law_leaves():
    feedforward, static = (
        run_headless(RunSettings(KnownSettings(SCENARIO, name)), NoFeedback())
        for name in ('feedforward', 'detailed')
    )
    left, growing = feedforward.slip_speed[START], static.slip_speed[START]
    assert growing > 50.0
    assert abs(left) < 0.06 * growing
    torsion_std_rpm = rpm_from_rad_s(feedforward.joint_speed[START:170, 3].std())
    assert torsion_std_rpm < 0.65  # an exact inverse leaves 1.9
