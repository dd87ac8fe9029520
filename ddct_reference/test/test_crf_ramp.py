"""CRF's reference follows the slip speed until control starts, then ramps to zero."""

import pytest

from ddct_reference.crf_ramp import CrfRamp


def run(ramp: CrfRamp, slips: list[float]) -> list[float]:
    return [ramp.update(step, slip)[0][0] for step, slip in enumerate(slips)]


def test_it_equals_the_slip_speed_until_control_starts():
    assert run(CrfRamp(50.0, 3), [1.0, 2.0, 4.0, 8.0]) == [1.0, 2.0, 4.0, 8.0]


def test_it_then_ignores_the_slip_speed_and_runs_to_zero_at_a_constant_slope():
    values = run(CrfRamp(100.0, 1), [5.0, 2.5, 99.0, -3.0, 7.0, 0.0])
    assert values == pytest.approx([5.0, 2.5, 1.5, 0.5, 0.0, 0.0])


def test_it_runs_to_zero_from_below_too():
    assert run(CrfRamp(100.0, 0), [-2.5, 0.0, 0.0, 0.0]) == pytest.approx([-2.5, -1.5, -0.5, 0.0])


def test_its_rate_is_that_of_the_ramp_and_zero_elsewhere():
    ramp = CrfRamp(100.0, 1)
    rates = [ramp.update(step, 2.5)[1][0] for step in range(6)]
    assert rates == [0.0, -100.0, -100.0, -100.0, 0.0, 0.0]


def test_the_preview_is_what_comes_once_control_is_on():
    ramp, preview = CrfRamp(100.0, 0), CrfRamp(100.0, 0, preview_steps=3)
    slips = [2.5] + [0.0] * 8
    ahead = [preview.update(step, slip)[0] for step, slip in enumerate(slips)]
    values = run(ramp, slips)
    for step in range(5):
        assert ahead[step] == values[step : step + 4]


def test_before_control_the_preview_ramps_down_from_the_slip_of_now():
    speeds, rates = CrfRamp(100.0, 2, preview_steps=4).update(0, 2.5)
    assert speeds == pytest.approx([2.5, 2.5, 2.5, 1.5, 0.5])
    assert rates == [0.0, 0.0, -100.0, -100.0, -100.0]
