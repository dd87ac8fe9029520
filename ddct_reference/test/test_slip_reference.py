# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""References follow the slip or a stored function until control starts, then run to zero."""

import numpy as np
import pytest

from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.choices.settings import ARCHITECTURES
from ddct_plant.scenario.control import REFERENCE_SHAPES
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings
from ddct_reference.descent import CrfRamp
from ddct_reference.factory import make_reference
from ddct_reference.slip_reference import DescendingReference, SlipReference

SLIPS = [0.0, 0.5, 1.5, 2.5, 9.0, -3.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0]


def values(reference: SlipReference, slips: list[float]) -> list[float]:
    return [reference.update(step, slip)[0][0] for step, slip in enumerate(slips)]


def following(slope: float, start_step: int, preview_steps: int = 0) -> DescendingReference:
    return DescendingReference(CrfRamp(slope), start_step, preview_steps)


def stored(preview_steps: int = 0) -> DescendingReference:
    return DescendingReference(CrfRamp(100.0), 3, preview_steps, [0.0, 1.0, 3.0, 3.5])


def test_it_equals_the_slip_speed_until_control_starts():
    assert values(following(50.0, 3), [1.0, 2.0, 4.0, 8.0]) == [1.0, 2.0, 4.0, 8.0]


def test_it_then_ignores_the_slip_speed_and_runs_to_zero_at_a_constant_slope():
    found = values(following(100.0, 1), [5.0, 2.5, 99.0, -3.0, 7.0, 0.0])
    assert found == pytest.approx([5.0, 2.5, 1.5, 0.5, 0.0, 0.0])


def test_it_runs_to_zero_from_below_too():
    found = values(following(100.0, 0), [-2.5, 0.0, 0.0, 0.0])
    assert found == pytest.approx([-2.5, -1.5, -0.5, 0.0])


def test_its_rate_is_that_of_the_ramp_and_zero_elsewhere():
    ramp = following(100.0, 1)
    rates = [ramp.update(step, 2.5)[1][0] for step in range(6)]
    assert rates == [0.0, -100.0, -100.0, -100.0, 0.0, 0.0]


def test_before_control_the_preview_ramps_down_from_the_present_slip():
    speeds, rates = following(100.0, 2, preview_steps=4).update(0, 2.5)
    assert speeds == pytest.approx([2.5, 2.5, 2.5, 1.5, 0.5])
    assert rates == [0.0, 0.0, -100.0, -100.0, -100.0]


def test_a_stored_reference_ignores_the_slip_speed_everywhere():
    found = values(stored(), SLIPS[:9])
    assert found == pytest.approx([0.0, 1.0, 3.0, 3.5, 2.5, 1.5, 0.5, 0.0, 0.0])


def test_the_rate_of_a_stored_reference_leads_from_each_value_to_the_next():
    reference = stored()
    rates = [reference.update(step, 0.0)[1][0] for step in range(3)]
    assert rates == pytest.approx([100.0, 200.0, 50.0])


@pytest.mark.parametrize(
    ('architecture', 'shape'),
    [
        (architecture, shape)
        for architecture in ARCHITECTURES
        for shape in REFERENCE_SHAPES
        if (architecture, shape) != ('feedforward_tanh', 'polynomial')
    ],
)
def test_the_preview_is_the_later_reference(architecture, shape):
    changes = [f'reference.shape={shape}', 'control_start_s=0.03', 'reference.reference_end_s=0.1']
    settings = RunSettings(KnownSettings(load_scenario('thesis', changes), architecture))
    ahead = make_reference(settings.known, preview_steps=4)
    speeds = [ahead.update(step, slip)[0] for step, slip in enumerate(SLIPS)]
    coming = values(make_reference(settings.known), SLIPS)
    first = settings.scenario.control_start_step if settings.detailed else 0
    for step in range(first, len(SLIPS) - 4):
        assert speeds[step] == coming[step : step + 5]


@pytest.mark.parametrize('preview_steps', [0, 1, 22])
@pytest.mark.parametrize(
    ('shape', 'architecture'),
    [
        *((shape, name) for shape in ('ramp', 'tanh', 'polynomial') for name in ARCHITECTURES[:2]),
        *((shape, 'detailed') for shape in ('ramp', 'polynomial', 'engine_speed_target')),
    ],
)
def test_the_preview_has_the_requested_length_at_every_step(shape, architecture, preview_steps):
    """At steps before control start, across it, and after the end of the descent."""
    changes = [f'reference.shape={shape}', 'control_start_s=0.1', 'reference.reference_end_s=0.3']
    if shape == 'engine_speed_target':
        changes += [
            'engine_speed_reference.time_s=[0.0]',
            'engine_speed_reference.speed_rad_s=[210.0]',
        ]
    settings = RunSettings(KnownSettings(load_scenario('thesis', changes), architecture))
    reference = make_reference(settings.known, preview_steps)
    for step in range(60):
        speeds, rates = reference.update(step, 20.0, 160.0)
        assert (len(speeds), len(rates)) == (preview_steps + 1, preview_steps + 1), step


@pytest.mark.parametrize('shape', ['tanh', 'polynomial'])
@pytest.mark.parametrize('end_s', [0.9, 1.3, 1.6, 1.97])
def test_a_timed_shape_reaches_exactly_zero_at_its_end_and_not_before(shape, end_s):
    changes = [f'reference.shape={shape}', f'reference.reference_end_s={end_s}']
    reference = make_reference(KnownSettings(load_scenario('thesis', changes), 'base'))
    found = np.array(values(reference, [0.0] * 210))
    end_step = round(100 * end_s)
    assert np.all(found[60:end_step] > 0.0)
    assert not np.any(found[end_step:])


def test_feedforward_tanh_differs_from_feedforward_only_after_control_start():
    scenario = load_scenario('thesis')
    start = scenario.control_start_step
    slips = [0.0] * (start + 20)
    ramp, tanh = (
        values(make_reference(KnownSettings(scenario, name)), slips)
        for name in ('feedforward', 'feedforward_tanh')
    )
    assert ramp[: start + 1] == tanh[: start + 1]
    assert all(
        above > below for above, below in zip(tanh[start + 1 :], ramp[start + 1 :], strict=True)
    )


def test_the_stored_reference_does_not_depend_on_the_wear_of_the_run():
    scenario = load_scenario('thesis')
    new, worn = (
        values(
            make_reference(
                RunSettings(KnownSettings(scenario, 'base'), CaseSettings(wear_gain=gain)).known
            ),
            [0.0] * 70,
        )
        for gain in (1.0, 0.7)
    )
    assert new == worn
    assert max(new) > 10.0


@pytest.mark.parametrize('shape', ['ramp', 'engine_speed_target'])
@pytest.mark.parametrize('preview_steps', [0, 3])
def test_in_a_shift_it_follows_the_slip_until_the_share_is_one_and_refuses_a_lower_one_then(
    shape, preview_steps
):
    changes = {
        'reference.shape': shape,
        'reference.slope_rad_s2': 100.0,
        'engine_speed_reference.time_s': [0.0],
        'engine_speed_reference.speed_rad_s': [100.0],
    }
    scenario = load_scenario('upshift', changes)
    reference = make_reference(KnownSettings(scenario), preview_steps)
    for step, slip in enumerate([50.0, 51.0, 52.0]):
        speeds, rates = reference.update(step, slip, 150.0, 0.25 * step)
        assert speeds == [slip] * (preview_steps + 1)
        assert rates == [0.0] * (preview_steps + 1)
    first, _ = reference.update(3, 52.5, 150.0)
    second, _ = reference.update(4, 99.0, 150.0)
    assert (first[0], second[0]) == pytest.approx((52.5, 51.5))
    with pytest.raises(DdctError, match='share 0.9 at step 5'):
        reference.update(5, 60.0, 150.0, 0.9)
