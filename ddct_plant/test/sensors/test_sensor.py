# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""One sensor: each of its errors alone, and all of them in their order."""

import dataclasses
import itertools
import math

import numpy as np
import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.sensors.parameters import EngineSpeedSensor, EngineTorqueSensor, SensorOptions
from ddct_plant.sensors.sensor import Sensor, ShaftSensor, ToothCount, gaussian, losses

Z = 4.5
"""Standard errors that an estimate may be off: by chance once in 150 000 tests."""
N = 40_000


def measured(options: SensorOptions, truth, seed: int = 0, quantity: str = 'engine_speed'):
    """Return the measured values and the flags of each step."""
    sensor = Sensor(options, quantity, seed)
    samples = [sensor.take(float(value)) for value in truth]
    return np.array([each.value for each in samples]), np.array([each.held for each in samples])


def ramp(steps: int) -> np.ndarray:
    return 100.0 + 0.37 * np.arange(steps)


def test_a_sensor_of_no_option_is_given_measures_the_truth_to_the_bit():
    values, held = measured(EngineSpeedSensor(), ramp(50))
    assert np.array_equal(values, ramp(50))
    assert not held.any()


def test_noise_has_its_mean_deviation_and_shape_and_no_memory():
    noise = measured(EngineSpeedSensor(noise_rad_s=0.2), np.full(N, 100.0))[0] - 100.0
    assert abs(noise.mean()) < Z * 0.2 / math.sqrt(N)
    assert abs(noise.std() / 0.2 - 1.0) < Z / math.sqrt(2 * N)
    within = np.mean(np.abs(noise) < 0.2)
    assert abs(within - 0.6827) < Z * math.sqrt(0.6827 * 0.3173 / N)
    neighbours = np.mean(noise[1:] * noise[:-1]) / 0.2**2
    assert abs(neighbours) < Z / math.sqrt(N)


def test_the_gain_multiplies_and_the_bias_adds():
    values, _ = measured(EngineTorqueSensor(gain=1.5, bias_n_m=-2.0), [10.0, 0.0, -4.0])
    assert values.tolist() == [13.0, -2.0, -8.0]


def test_a_quantum_rounds_to_its_nearest_multiple_also_after_the_noise():
    truth = ramp(300)
    values, _ = measured(EngineSpeedSensor(quantum_rad_s=0.25), truth)
    assert np.array_equal(values % 0.25, np.zeros(300))
    assert np.abs(values - truth).max() <= 0.125
    noisy, _ = measured(EngineSpeedSensor(quantum_rad_s=0.25, noise_rad_s=1.0), truth)
    assert np.array_equal(noisy % 0.25, np.zeros(300))
    assert not np.array_equal(noisy, values)


@pytest.mark.parametrize('truth', [1e300, math.inf, math.nan])
def test_a_quantum_lets_the_numbers_of_a_loop_that_diverges_pass(truth):
    (value,), _ = measured(EngineSpeedSensor(quantum_rad_s=1e-300), [truth])
    assert value == truth or math.isnan(truth)


def test_a_delayed_sensor_repeats_its_first_value_until_the_delay_has_passed():
    truth = ramp(30)
    values, held = measured(EngineSpeedSensor(delay_s=0.03), truth)
    assert values.tolist() == [truth[0]] * 3 + truth[:27].tolist()
    assert not held.any()


def test_a_delayed_noise_is_the_same_noise_later():
    now, _ = measured(EngineSpeedSensor(noise_rad_s=0.2, quantum_rad_s=0.01), ramp(60))
    later, _ = measured(
        EngineSpeedSensor(noise_rad_s=0.2, quantum_rad_s=0.01, delay_s=0.05), ramp(60)
    )
    assert later[5:].tolist() == now[:55].tolist()
    assert set(later[:5]) == {now[0]}


def test_a_lost_sample_repeats_the_last_that_came_and_is_flagged():
    truth = ramp(4000)
    values, held = measured(EngineSpeedSensor(dropout=0.3, delay_s=0.01), truth)
    delayed, _ = measured(EngineSpeedSensor(delay_s=0.01), truth)
    assert not held[0]
    assert 0 < held.sum() < len(held)
    last = values[0]
    for value, lost, sent in zip(values, held, delayed, strict=True):
        last = last if lost else sent
        assert value == last


@pytest.mark.parametrize('share', [0.02, 0.3, 0.9])
def test_samples_are_lost_in_their_share_each_by_itself(share):
    _, held = measured(EngineSpeedSensor(dropout=share), np.zeros(N))
    assert abs(held.mean() - share) < Z * math.sqrt(share * (1 - share) / N)
    after_lost = held[1:][held[:-1]]
    allowed = Z * math.sqrt(share * (1 - share) / len(after_lost))
    assert abs(after_lost.mean() - share) < allowed


@pytest.mark.parametrize(('share', 'burst'), [(0.1, 5.0), (0.5, 1.0), (0.8, 20.0)])
def test_bursts_have_their_mean_length_and_the_share_stays(share, burst):
    _, held = measured(EngineSpeedSensor(dropout=share, dropout_burst=burst), np.zeros(N))
    edges = np.flatnonzero(np.diff(np.concatenate([[False], held, [False]]).astype(int)))
    lengths = edges[1::2] - edges[::2]
    # Lengths are geometric; the share of a chain varies by its correlation time more.
    allowed = Z * burst / math.sqrt(len(lengths))
    assert abs(lengths.mean() - burst) <= (allowed if burst > 1.0 else 0.0)
    again = 1.0 - 1.0 / burst - share / ((1.0 - share) * burst)
    variance = share * (1 - share) / N * (1 + again) / (1 - again)
    assert abs(held.mean() - share) < Z * math.sqrt(variance) + 1.0 / N


def test_the_seed_gives_the_numbers_and_another_seed_others():
    options = EngineSpeedSensor(noise_rad_s=0.2, dropout=0.3)
    first, again, other = (measured(options, ramp(300), seed) for seed in (7, 7, 8))
    assert np.array_equal(first, again)
    assert not np.array_equal(first[0], other[0])
    assert not np.array_equal(first[1], other[1])


@pytest.mark.parametrize('seed', [0, 2**31 - 1])
def test_quantities_have_numbers_of_their_own(seed):
    options = EngineSpeedSensor(noise_rad_s=1.0)
    one, other = (
        measured(options, np.zeros(N), seed, name)[0] for name in ('engine_speed', 'shaft_speed')
    )
    assert abs(np.mean(one * other)) < Z / math.sqrt(N)


def test_losses_leave_the_noise_as_it_is_and_do_not_depend_on_it():
    noisy = EngineSpeedSensor(noise_rad_s=1.0)
    values, held = measured(dataclasses.replace(noisy, dropout=0.5), np.zeros(500))
    assert np.array_equal(values[~held], measured(noisy, np.zeros(500))[0][~held])
    # The first numbers of many seeds: later ones of one stream would part by themselves. A draw
    # below 1/16 has four leading zeros, of which numpy takes the size of a normal number too.
    rare = EngineSpeedSensor(dropout=1.0 / 16.0)
    sizes: dict[bool, list[float]] = {True: [], False: []}
    for seed in range(2000):
        _, lost = itertools.islice(losses(seed, 'w', rare), 2)
        sizes[lost].append(abs(next(gaussian(seed, 'w'))))
    means = [np.mean(each) for each in sizes.values()]
    deviation = math.sqrt(1.0 - 2.0 / math.pi) * math.hypot(
        *(1.0 / math.sqrt(len(each)) for each in sizes.values())
    )
    assert abs(means[0] - means[1]) < Z * deviation


def test_teeth_are_counted_over_the_time_that_is_given():
    speed, teeth, periods = 157.3, 60, 3
    counter = ToothCount(teeth, periods)
    step = 2.0 * math.pi / (teeth * periods * 0.01)
    counted = np.array([counter.take(k * 0.01 * speed, speed) for k in range(2000)])
    np.testing.assert_allclose(counted / step, np.round(counted / step), atol=1e-9)
    assert np.abs(counted - speed).max() < step
    assert abs(counted.mean() - speed) < periods * step / 2000
    assert len(set(np.round(counted / step))) == 2


def test_a_count_is_the_mean_over_its_time_and_signed():
    counter = ToothCount(100_000, 2)
    positions = [0.0, 0.1, 0.3, 0.2, 0.0]
    counted = [counter.take(position, 10.0) for position in positions]
    np.testing.assert_allclose(counted, [10.0, 10.0, 15.0, 5.0, -15.0], atol=0.01)


def test_errors_of_a_shaft_sensor_come_after_the_count():
    truth = 157.3
    counted = ShaftSensor(EngineSpeedSensor(teeth=60), 'engine_speed', 0)
    biased = ShaftSensor(EngineSpeedSensor(teeth=60, bias_rad_s=1.0), 'engine_speed', 0)
    plain = ShaftSensor(EngineSpeedSensor(), 'engine_speed', 0)
    for k in range(50):
        one, more, true = (each.take(k * 0.01 * truth, truth) for each in (counted, biased, plain))
        assert more.value == one.value + 1.0
        assert true.value == truth
        assert one.value != truth


@pytest.mark.parametrize(
    ('given', 'key'),
    [
        ({'noise_rad_s': -1.0}, 'sensors.engine_speed.noise_rad_s'),
        ({'noise_rad_s': math.inf}, 'sensors.engine_speed.noise_rad_s'),
        ({'dropout': 1.0}, 'sensors.engine_speed.dropout'),
        ({'dropout': -0.1}, 'sensors.engine_speed.dropout'),
        ({'dropout': 1.5}, 'sensors.engine_speed.dropout'),
        ({'dropout': 0.8, 'dropout_burst': 2.0}, 'sensors.engine_speed.dropout_burst'),
        ({'dropout_burst': 0.5}, 'sensors.engine_speed.dropout_burst'),
        ({'delay_s': 0.015}, 'sensors.engine_speed.delay_s'),
        ({'delay_s': -0.01}, 'sensors.engine_speed.delay_s'),
        ({'gain': 0.0}, 'sensors.engine_speed.gain'),
        ({'teeth': 1.5}, 'sensors.engine_speed.teeth'),
        ({'count_s': 0.0}, 'sensors.engine_speed.count_s'),
        ({'quantum_rad_s': math.nan}, 'sensors.engine_speed.quantum_rad_s'),
    ],
)
def test_a_bad_value_is_refused_by_its_key(given, key):
    with refused(ParameterError, key=key):
        EngineSpeedSensor(**given)
