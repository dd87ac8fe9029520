# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Runs that can be computed in a batch, and the one-line reason for the others."""

import dataclasses
import os

import numpy as np
import pytest

from ddct_bringup.batch import batchable
from ddct_bringup.batch.batchable import SUPPORTED_KEYS, needs_trial, why_not_batchable
from ddct_bringup.batch.controllers.trial import why_not_linear
from ddct_bringup.batch.run_batch import run_batch
from ddct_bringup.campaign.rows import scored_headless
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.from_python import chosen_from
from ddct_controllers.interface import Command, Controller
from ddct_controllers.linear import LinearController, PiController
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.costs import PREVIEW
from ddct_controllers.mpc.estimators import make_observer
from ddct_controllers.mpc.model.transmission_model import transmission_model
from ddct_controllers.registry import make_controller
from ddct_plant.base.options import key_of
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
PI = PiController(0.1, 0.1)
MODEL = transmission_model(SETTINGS.scenario.controlled_driveline)
SUPPORTED = (
    *('mpc1', 'mpc_preview', 'mpc_offset_free', 'mpc_torsion', 'mpc_wear'),
    'least_jerk',
)


class Proportional(Controller):
    """A user's controller with a linear model."""

    gain = -0.1

    def reset(self):
        """Do nothing: there is no state."""

    def update(self, measurement):
        return Command(self.gain * measurement.slip_error_rpm)

    def linear_model(self):
        none = np.zeros((0, 0))
        return StateSpace(
            none, np.zeros((0, 1)), np.zeros((1, 0)), np.full((1, 1), self.gain), PERIOD_S
        )


class Saturated(Proportional):
    def update(self, measurement):
        return Command(min(super().update(measurement).clutch_torque, 50.0))


class Led(Proportional):
    def update(self, measurement):
        return Command(super().update(measurement).clutch_torque + measurement.engine_torque)


class Remembering(Proportional):
    def hold(self, measurement):
        """Keep the state."""


class Broken(Proportional):
    def update(self, measurement):
        raise ValueError('no')


class OwnStep(MpcController):
    """A user's variant of a predictive controller."""

    def update(self, measurement):
        return Command(0.0)


class Limited(PiController):
    def update(self, measurement):
        return Command(min(super().update(measurement).clutch_torque, 50.0))


class Preloaded(PiController):
    def reset(self):
        self._integral_rpm_s = -5000.0


class Fading(Proportional):
    def update(self, measurement):
        share = 1.0 if measurement.step <= 100 else 0.5
        return Command(share * super().update(measurement).clutch_torque)


class Ending(Proportional):
    def update(self, measurement):
        os._exit(3)


class Unprepared(PiController):
    def __init__(self):
        """Leave out what `PiController` does."""


@pytest.mark.process
@pytest.mark.parametrize(
    ('controller', 'reason'),
    [
        (PI, ''),
        (LinearController(Proportional().linear_model()), ''),
        (Proportional(), ''),
        (Saturated(), 'the controller does not do what its linear_model says'),
        (Limited(0.1, 0.1), 'the controller does not do what its linear_model says'),
        (Led(), 'the controller does not do what its linear_model says'),
        (Preloaded(0.1, 0.1), 'the controller does not do what its linear_model says'),
        (Fading(), 'the controller does not do what its linear_model says'),
        (Remembering(), 'the controller does more than reset while feedback is held off'),
        (Broken(), 'the controller failed when it was tried (ValueError: no)'),
        (Ending(), 'its process failed when the controller was tried: it ended with exit code 3'),
        (
            Unprepared(),
            "the controller failed when it was tried (AttributeError: 'Unprepared' object has no "
            "attribute '_gains')",
        ),
        *((make_controller(name, SETTINGS.known), '') for name in SUPPORTED),
        (
            make_controller('mpc3', SETTINGS.known, {'backend': 'osqp'}),
            'the solver of its programs is osqp',
        ),
        (
            make_controller('mpc3', SETTINGS.known, {'iteration_limit': 5}),
            'the iterations of its solver are limited',
        ),
        (make_controller('mpc4', SETTINGS.known), 'the controller commands the engine'),
        (make_controller('mpc4_wear', SETTINGS.known), 'the controller commands the engine'),
        (
            make_controller('least_jerk', KnownSettings(load_scenario('tip_in'))),
            'the controller commands the engine',
        ),
        (
            OwnStep(MODEL, make_observer(SETTINGS.known, MODEL), PREVIEW.settings()),
            'the controller does more than reset while feedback is held off',
        ),
    ],
)
def test_a_controller_is_in_a_batch_if_its_kind_is_supported(controller, reason):
    found = why_not_batchable(SETTINGS, controller)
    if not found and needs_trial(controller):
        (found,) = why_not_linear([controller])
    assert found.startswith(reason)
    assert bool(found) == bool(reason)
    assert '\n' not in found


@pytest.mark.process
def test_a_controller_that_ends_its_process_says_nothing_of_others():
    assert [not why for why in why_not_linear([Proportional(), Ending(), Proportional()])] == [
        *(True, False, True)
    ]


@pytest.mark.parametrize(
    ('changes', 'settings', 'reason'),
    [
        ({}, {'mode': 'realtime'}, 'the mode is realtime'),
        (
            {
                'reference.shape': 'engine_speed_target',
                'engine_speed_reference': {'time_s': [0.0], 'speed_rad_s': [170.0]},
            },
            {},
            'reference.shape is engine_speed_target',
        ),
    ],
)
def test_a_run_has_the_reason_why_it_is_not_in_a_batch(changes, settings, reason):
    assert (
        why_not_batchable(RunSettings.of(load_scenario('thesis', changes), settings), PI) == reason
    )


@pytest.mark.parametrize(
    'changes',
    [
        {'clutch': 'stick_slip', 'closing': {}, 'friction.most_n_m': 300.0, 'heat.plate_c': 50.0},
        {'clutch': 'stick_slip', 'brake': {'time_s': [0.0], 'torque_n_m': [100.0]}},
        {'engine_limits': {}, 'engine.torque_n_m': [0.0, 200.0]},
        {'sensors.engine_speed.noise_rad_s': 0.1},
    ],
)
def test_a_plant_with_friction_limits_or_sensors_is_in_a_batch(changes):
    assert not why_not_batchable(RunSettings.of(load_scenario('thesis', changes), {}), PI)


def test_a_run_with_a_key_that_is_not_listed_is_not_in_a_batch(monkeypatch):
    assert {key_of(field) for field in dataclasses.fields(Scenario)} <= SUPPORTED_KEYS
    settings = RunSettings.of(load_scenario('upshift'), {})
    assert not why_not_batchable(settings, PI)
    monkeypatch.setattr(batchable, '_UNSUPPORTED', [('shift', None)])
    assert why_not_batchable(settings, PI) == 'the scenario gives shift'


def test_a_foreign_linear_controller_has_the_results_of_the_run_step_by_step():
    controller = Proportional()
    (ours,) = run_batch([(SETTINGS, controller)], packaged_limits())
    assert ours is not None
    expected = scored_headless(SETTINGS, chosen_from(controller), packaged_limits())
    for name, value in expected.metrics.items():
        assert ours.metrics[name] == (None if value is None else pytest.approx(value, rel=1e-9))
