# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A batch of runs whose plates stick gives those of the run step by step."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from batch_runs import bits_of, engine, friction, road, sensors, short_run, some
from step_by_step import LIMITS

from ddct_bringup.batch.batchable import why_not_batchable
from ddct_bringup.batch.run_batch import run_batch
from ddct_bringup.batch.simulate import loop_kind
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

pytestmark = pytest.mark.slow
DRIVES = ('launch', 'launch_gentle', 'launch_hill', 'launch_hot', 'tip_in')
CARS = ('c635', 'c635_no_limits', 'city7')
ARCHITECTURES = ('detailed', 'detailed', 'feedforward', 'base')


PARTS = {'plain': lambda random: {}, **{f.__name__: f for f in (friction, road, sensors, engine)}}


def drawn(random, drive, car, part):
    """Return a run of a packaged drive with a car, with random values of one part of the plant."""
    changes = {
        'vehicle.mass_kg': some(random, 1000.0, 2000.0),
        'actuator.delay_s': int(random.integers(0, 35)) / 1000,
        'load.wind_speed_m_s': some(random, -15.0, 15.0),
        **PARTS[part](random),
    }
    settings = RunSettings(
        KnownSettings(
            load_scenario(None, changes, car=car, drive=drive), str(random.choice(ARCHITECTURES))
        ),
        CaseSettings(wear_gain=some(random, 0.5, 1.2), seed=int(random.integers(1000))),
    )
    name = str(random.choice(['ls8', 'hinf1', 'ls3', 'pi']))
    return settings, make_controller(name, settings.known)


def drawn_runs(seed):
    random, runs = np.random.default_rng(seed), []
    for drive in DRIVES:
        for car in CARS:
            for part in random.choice(list(PARTS), 2, replace=False).tolist():
                try:
                    runs.append(drawn(random, drive, car, part))
                except DdctError:
                    continue  # a drive that does not fit the car
    return runs


@pytest.fixture(scope='module')
def runs():
    found = drawn_runs(4)
    assert len(found) >= 15
    return found


def test_signals_events_and_lengths_are_those_of_the_run_step_by_step(runs, batch, serial):
    assert {why_not_batchable(*run) for run in runs} == {''}
    kinds: Counter[str] = Counter()
    ends, unsure = set(), 0
    for (settings, _), (_, signals), (_, expected) in zip(runs, batch, serial, strict=True):
        if signals is None:
            unsure += 1
            continue
        ends.add(expected.steps < settings.scenario.steps)
        for name, ours in signals.items():
            theirs = getattr(expected, name)
            if name == 'phase_events':
                kinds.update(assert_same_events(ours, theirs))
                continue
            assert ours.shape == theirs.shape
            difference = np.abs(ours - theirs).max()
            assert difference <= 1e-9 * np.abs(theirs).max(), (name, settings.scenario.name)
    assert min(kinds['lock'], kinds['release']) > 5
    assert ends == {True, False}
    assert unsure <= 0.1 * len(runs)


def assert_same_events(ours, theirs):
    """Check that events are the same to rounding; return their kinds."""
    kinds = []
    for mine, other in zip(ours, theirs, strict=True):
        assert [each.kind for each in mine] == [each.kind for each in other]
        kinds += [each.kind for each in mine]
        for one, same in zip(mine, other, strict=True):
            assert one.time_s == pytest.approx(same.time_s, rel=1e-9)
            slope = same.slip_acceleration
            assert one.slip_acceleration == pytest.approx(slope, rel=1e-6, abs=1e-6)
    return kinds


def test_figures_states_and_limits_are_those_of_the_run_step_by_step(batch, serial):
    states: Counter[str] = Counter()
    for (ours, _), (expected, _) in zip(batch, serial, strict=True):
        if ours is None:
            continue
        states[ours.state] += 1
        assert (ours.valid, ours.reason, ours.state, ours.why) == (
            *(expected.valid, expected.reason, expected.state, expected.why),
        )
        for name, value in expected.metrics.items():
            close = None if value is None else pytest.approx(value, rel=1e-8, abs=1e-9)
            assert ours.metrics[name] == close, name
        for limit, other in zip(ours.limits, expected.limits, strict=True):
            assert limit == replace(other, value=limit.value)
    assert len(states) >= 3
    assert sum(states.values()) >= 0.9 * len(batch)


@pytest.mark.parametrize('size', [1, 2, 3, 33])
def test_a_run_does_not_depend_on_the_rest_of_a_batch(size):
    """The runs of a batch have the bits that they have alone, in any order."""
    chosen = [short_run(seed) for seed in range(size)]
    alone = [bits_of([run])[0] for run in chosen[:: size // 3 or 1]]
    order = np.random.default_rng(size).permutation(size).tolist()
    together, mixed = bits_of(chosen), bits_of([chosen[place] for place in order])
    assert together[:: size // 3 or 1] == alone
    assert mixed == [together[place] for place in order]


def test_runs_of_other_drives_are_in_one_batch_and_change_no_bit_or_figure():
    starts = {'thesis_sticking': 0.2, 'launch': 0.1, 'tip_in': 0.3}
    runs = []
    for scenario, start_s in starts.items():
        changes = {
            **{'duration_s': 0.8, 'control_start_s': start_s},
            'score_window_s': [0.3, 0.7],
        }
        settings = RunSettings(KnownSettings(load_scenario(scenario, changes)))
        runs.append((settings, make_controller('ls8', settings.known)))
    described = [settings.scenario for settings, _ in runs]
    assert len({each.equilibrium for each in described}) == 2
    assert {each.closing is None for each in described} == {True, False}
    assert {each.engine_limits is None for each in described} == {True, False}
    assert len({loop_kind(settings) for settings, _ in runs}) == 1
    assert bits_of(runs) == [bits_of([run])[0] for run in runs]
    assert run_batch(runs, LIMITS) == [run_batch([run], LIMITS)[0] for run in runs]
