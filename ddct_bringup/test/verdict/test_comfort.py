# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Jerk and weighted acceleration of signals with known values."""

import numpy as np
import pytest

from ddct_bringup.metrics.signals.vibration import jerk, strongest_stretch, weighted_acceleration

TIME = np.arange(4001) / 100.0


def sine(frequency_hz):
    return np.sin(2.0 * np.pi * frequency_hz * TIME)


def test_jerk_of_a_ramp_is_its_slope():
    inside = slice(100, -100)
    assert jerk(3.0 * TIME)[inside] == pytest.approx(np.full(3800, 3.0), abs=1e-9)


def test_jerk_of_a_slow_sine_is_its_derivative_without_delay():
    middle = (TIME[:-1] + TIME[1:]) / 2.0
    expected = 2.0 * np.pi * np.cos(2.0 * np.pi * middle)
    inside = slice(100, -100)
    assert jerk(sine(1.0))[inside] == pytest.approx(expected[inside], abs=2.0 * np.pi * 1e-3)


def test_jerk_filter_halves_20_hz():
    amplitude = np.max(np.abs(jerk(sine(20.0))[1000:3000]))
    difference_of_samples = 2.0 * np.sin(np.pi * 20.0 * 0.01) / 0.01
    assert amplitude == pytest.approx(0.5 * difference_of_samples, rel=2e-3)


def test_jerk_of_nine_samples_is_undefined():
    assert jerk(np.arange(9.0)).size == 0


# One-third octave factors of W_d as ISO 2631-1 tabulates them, up to where sampling at 100 Hz
# still shows the analogue filter.
@pytest.mark.parametrize(
    ('frequency_hz', 'factor'),
    [(0.5, 0.853), (1.0, 1.011), (2.0, 0.890), (4.0, 0.512), (8.0, 0.253)],
)
def test_weighting_has_the_factors_of_the_standard(frequency_hz, factor):
    settled = weighted_acceleration(sine(frequency_hz))[2000:]
    assert np.max(np.abs(settled)) == pytest.approx(factor, rel=0.03)


def test_weighting_starts_in_equilibrium():
    assert weighted_acceleration(np.full(100, 5.0)) == pytest.approx(np.zeros(100), abs=1e-9)


def test_the_strongest_stretch_is_the_largest_running_rms():
    jolt = np.where((TIME >= 20.0) & (TIME < 20.5), 2.0, 0.0)
    assert strongest_stretch(jolt, 100) == pytest.approx(2.0 * np.sqrt(0.5))
    assert strongest_stretch(jolt, 50) == pytest.approx(2.0)
    every = [np.sqrt(np.mean(sine(1.3)[k : k + 100] ** 2)) for k in range(len(TIME) - 99)]
    assert strongest_stretch(sine(1.3), 100) == pytest.approx(max(every), rel=1e-12)


# W_d of ISO 8041-1 at the band centres 10^(n/10) Hz, from its parameters f1 = 0.4, f2 = 100,
# f3 = f4 = 2 Hz and Q4 = 0.63, and its value at 100 rad/s, which instruments are calibrated by.
def weight(frequency_hz):
    s = 2j * np.pi * frequency_hz
    w1, w2, w3 = 2 * np.pi * 0.4, 2 * np.pi * 100.0, 2 * np.pi * 2.0
    band = s**2 / (s**2 + np.sqrt(2) * w1 * s + w1**2)
    band *= w2**2 / (s**2 + np.sqrt(2) * w2 * s + w2**2)
    return abs(band * (1 + s / w3) / (1 + s / (0.63 * w3) + (s / w3) ** 2))


def test_the_parameters_give_the_weight_that_instruments_are_calibrated_by():
    assert weight(100.0 / (2 * np.pi)) == pytest.approx(0.1261, abs=5e-5)


@pytest.mark.parametrize('n', range(-4, 12))
def test_weighting_keeps_the_tolerance_of_the_standard_up_to_13_hz(n):
    frequency_hz = 10.0 ** (n / 10.0)
    settled = weighted_acceleration(sine(frequency_hz))[2000:]
    rms = np.sqrt(2.0 * np.mean(settled**2))
    assert rms == pytest.approx(weight(frequency_hz), rel=0.11)
