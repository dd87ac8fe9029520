# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The filters of the metrics have the coefficients and the bits of scipy.signal."""

from functools import cache

import numpy as np
import pytest
import scipy

from ddct_bringup.metrics.signals import filters
from ddct_bringup.metrics.signals.vibration import jerk, judder_of, weighted_acceleration
from ddct_plant.base.timebase import PERIOD_S

RATE_HZ = 1.0 / PERIOD_S
SIGNALS = np.cumsum(np.random.default_rng(2).standard_normal((3, 400)), axis=1)


def analogue_weighting():
    high_pass, corner, quality = 2.0 * np.pi * 0.4, 2.0 * np.pi * 2.0, 0.63
    yield [1.0, 0.0, 0.0], [1.0, np.sqrt(2.0) * high_pass, high_pass**2]
    yield [1.0 / corner, 1.0], [1.0 / corner**2, 1.0 / (quality * corner), 1.0]


NAMES = ('LOW_PASS', 'BAND_PASS', 'WEIGHTING')


@cache
def sections(name):
    """Return the sections of a filter by scipy, which takes a second to load."""
    if name == 'LOW_PASS':
        return [scipy.signal.butter(2, 20.0, fs=RATE_HZ)]
    if name == 'WEIGHTING':
        return [scipy.signal.bilinear(*section, fs=RATE_HZ) for section in analogue_weighting()]
    band = scipy.signal.butter(2, filters.BAND_HZ, 'bandpass', fs=RATE_HZ, output='sos')
    return [(section[:3], section[3:]) for section in band]


@pytest.mark.parametrize('name', NAMES)
def test_coefficients_and_states_are_those_of_scipy(name):
    expected = [
        [*numerator, *denominator[1:], *scipy.signal.lfilter_zi(numerator, denominator)]
        for numerator, denominator in sections(name)
    ]
    assert getattr(filters, name) == pytest.approx(np.array(expected), rel=1e-14)


@pytest.mark.parametrize('name', NAMES)
@pytest.mark.parametrize('signals', [SIGNALS, SIGNALS[0], SIGNALS[:, :1], SIGNALS[np.newaxis]])
def test_both_means_give_the_same_bits(name, signals):
    for section in getattr(filters, name):
        one, other = (apply(section, signals) for apply in (filters.by_steps, filters.by_scipy))
        assert one.shape == other.shape
        assert one.tobytes() == other.tobytes()


def test_jerk_is_that_of_filtfilt():
    smooth = scipy.signal.filtfilt(*sections('LOW_PASS')[0], SIGNALS)
    assert jerk(SIGNALS) == pytest.approx(np.diff(smooth) / PERIOD_S, rel=1e-10, abs=1e-10)


def test_weighting_is_that_of_sosfilt_in_equilibrium():
    sos = np.array([np.hstack(section) for section in sections('WEIGHTING')])
    states = scipy.signal.sosfilt_zi(sos)[:, np.newaxis] * SIGNALS[:, :1]
    expected, _ = scipy.signal.sosfilt(sos, SIGNALS, zi=states)
    assert weighted_acceleration(SIGNALS) == pytest.approx(expected, abs=1e-10)


def test_judder_is_that_of_sosfiltfilt_on_each_interval():
    sos = np.array([np.hstack(section) for section in sections('BAND_PASS')])
    first, after = np.array([0, 30, 399]), np.array([400, 130, 400])
    expected = [
        np.sqrt(np.mean(scipy.signal.sosfiltfilt(sos, signal[begin:end]) ** 2))
        for signal, begin, end in zip(SIGNALS[:2], first, after, strict=False)
    ]
    found = judder_of(SIGNALS, first, after)
    assert found == pytest.approx([*expected, np.nan], rel=1e-9, nan_ok=True)


def test_a_process_that_filters_much_uses_scipy(monkeypatch):
    monkeypatch.setattr(filters, 'by_scipy', lambda section, values: 'from scipy')
    recursion = filters.Recursion()
    signal = np.ones(filters.Recursion.STEPS_BEFORE_IMPORT // 2)
    assert recursion(filters.LOW_PASS[0], signal) == pytest.approx(signal)
    assert recursion(filters.LOW_PASS[0], signal) == 'from scipy'
