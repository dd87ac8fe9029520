# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Runs with random values of each part of a plant, and the bits that a batch gives them."""

from collections import defaultdict

import numpy as np

from ddct_bringup.batch.results import part_of_stack
from ddct_bringup.batch.simulate import loop_kind, simulate_batch
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings


def some(random, low, high):
    return float(random.uniform(low, high))


def friction(random):
    return {
        'friction.static_over_kinetic': some(random, 1.0, 1.3),
        'friction.kiss_torque_n_m': some(random, 0.0, 10.0),
        'friction.kiss_drift_n_m_k': some(random, 0.0, 0.2),
        'friction.slip_rad_s': [0.0, 50.0, 200.0],
        'friction.slip_share': [1.0, some(random, 0.8, 1.0), 0.8],
        'heat.facing_c': some(random, 20.0, 330.0),
    }


def road(random):
    times = {'time_s': [0.0, 0.5, 1.0, 1.5]}
    torques = random.uniform(0.0, 400.0, 3).tolist()
    slopes = random.uniform(-0.1, 0.1, 4).tolist()
    return {
        'brake': {**times, 'torque_n_m': [*torques, 0.0]},
        'load.slope_rad': 0.0,
        'slope': {**times, 'slope_rad': slopes},
    }


def sensors(random):
    return {
        'sensors.engine_speed.noise_rad_s': some(random, 0.0, 0.3),
        'sensors.shaft_speed.teeth': int(random.integers(40, 80)),
        'sensors.shaft_speed.count_s': 0.02,
        'sensors.wheel_speed.quantum_rad_s': 0.05,
        'sensors.engine_torque.delay_s': 0.01 * int(random.integers(0, 4)),
        'sensors.engine_torque.bias_n_m': some(random, -3.0, 3.0),
        'sensors.vehicle_speed.dropout': 0.2,
    }


def engine(random):
    return {
        'engine_limits.idle_rad_s': some(random, 100.0, 104.0),
        'engine_limits.stall_rad_s': some(random, 94.0, 99.0),
        'closing.dwell_s': 0.05,
        'closing.margin': some(random, 1.0, 2.0),
    }


def short_run(seed):
    """Return a short launch: random delay, friction, road, sensors and limits, several lengths."""
    random = np.random.default_rng(seed)
    changes = {
        'duration_s': (12 + seed % 3) / 10,
        **{'control_start_s': 0.2, 'score_window_s': [0.2, 1.1]},
        'vehicle.mass_kg': 1500.0 if seed % 2 else some(random, 1000.0, 2000.0),
        'actuator.delay_s': int(random.integers(0, 35)) / 1000,
        **{**friction(random), **road(random), **sensors(random), **engine(random)},
    }
    settings = RunSettings(
        KnownSettings(load_scenario('launch', changes)),
        CaseSettings(wear_gain=some(random, 0.5, 1.2), seed=seed),
    )
    return settings, make_controller('ls8', settings.known)


def signals_until_end(stack, index):
    """Return the signals of a run of a stack up to its end, or None if it is unsure."""
    if stack.unsure[index]:
        return None
    end = int(stack.last[index]) + 1
    signals = part_of_stack(stack.trajectory, index).signals
    return {name: values[:end] for name, values in signals.items()}


def simulated(runs):
    """Yield the place of each run with its signals in a batch up to its end, or None if unsure."""
    groups = defaultdict(list)
    for place, (settings, _) in enumerate(runs):
        groups[loop_kind(settings)].append(place)
    for places in groups.values():
        settings, controllers = zip(*[runs[place] for place in places], strict=True)
        found = simulate_batch(settings, controllers)
        for index, place in enumerate(places):
            yield place, signals_until_end(found, index)


def bits_of(runs):
    """Return the bits of all signals of each run."""

    def bits(signals):
        return signals and {
            name: values.tolist() if values.dtype == object else values.tobytes()
            for name, values in signals.items()
        }

    found = {place: bits(signals) for place, signals in simulated(runs)}
    return [found[place] for place in range(len(runs))]
