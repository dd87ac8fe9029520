# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A measurement that a controller cannot use is refused by name, and leaves no trace."""

import math
from dataclasses import replace

import pytest
from refusals import refused

from ddct_controllers.interface import Measurement
from ddct_controllers.measurement import MOST, measured_speeds
from ddct_controllers.mpc.variants import PREDICTIVE
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
CONTROLLERS = (*PREDICTIVE, 'pedal_mpc', 'decoupled_pid', 'torque_estimator')
SCALARS = (
    *('engine_speed', 'shaft_speed', 'wheel_speed'),
    *('engine_torque', 'load_torque', 'open_loop_torque'),
)
REFERENCES = ('slip_reference', 'slip_reference_rate')


def measurement(step, preview):
    references = [50.0 - i for i in range(preview + 1)], [-100.0] * (preview + 1)
    return Measurement(step, 240.0, 190.0, 20.0, 6.5, 308.0, *references, 60.0, 271.0)


def spoilt(good, field, value):
    if field in REFERENCES:
        return replace(good, **{field: [*getattr(good, field)[:-1], value]})
    return replace(good, **{field: value})


@pytest.mark.parametrize('way', ['hold', 'update'])
@pytest.mark.parametrize(
    ('name', 'field'),
    [
        *((name, 'engine_speed') for name in CONTROLLERS),
        *(('mpc3', field) for field in (*SCALARS[1:], *REFERENCES)),
    ],
)
def test_no_number_is_refused_and_leaves_no_trace(name, way, field):
    controllers = [make_controller(name, SETTINGS.known) for _ in range(2)]
    preview = controllers[0].preview_steps
    for each in controllers:
        for step in range(58, 60):
            each.hold(measurement(step, preview))
    used, other = controllers
    with pytest.raises(DdctError, match=rf'{field}.* is nan .* at step 60, .* mend what gives it'):
        getattr(used, way)(spoilt(measurement(60, preview), field, math.nan))
    assert used.update(measurement(60, preview)) == other.update(measurement(60, preview))


@pytest.mark.parametrize('value', [math.inf, -math.inf, 1.1 * MOST, -1.1 * MOST])
@pytest.mark.parametrize('field', [*SCALARS, *REFERENCES])
def test_beyond_the_largest_size_is_refused(field, value):
    with pytest.raises(DdctError) as caught:
        measured_speeds(spoilt(measurement(3, 4), field, value))
    assert caught.value.key.partition('[')[0] == field


def test_the_period_ahead_is_named():
    with refused(DdctError, key='slip_reference[4]'):
        measured_speeds(spoilt(measurement(3, 4), 'slip_reference', math.nan))


def test_many_large_numbers_are_no_error():
    """Their sum is beyond the largest size, each by itself is within."""
    good = measurement(3, 4)
    for field in (*SCALARS, *REFERENCES):
        good = spoilt(good, field, MOST)
    assert measured_speeds(good) == (MOST, MOST, MOST)
