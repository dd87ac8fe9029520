# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The handover `adaptive` measures what the on-coming clutch carries, and corrects its request."""

from dataclasses import replace

import pytest
from handed_over import Tick, flare, shift, tie_up_work
from shifts import shift_settings

from ddct_controllers.handover import adaptive
from ddct_controllers.handover.adaptive import RESERVE, RESERVE_FADES_S, AdaptiveHandover
from ddct_controllers.handover.interface import (
    Handover,
    HandoverCommand,
    HandoverMeasurement,
)
from ddct_controllers.handover.on_coming_estimate import MOST_GAIN
from ddct_plant.base.timebase import steps_in
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, RunSettings
from ddct_plant.shift.balance import WHOLE, OnComingShare

WEAR = (0.7, 1.0, 1.3)
SHIFTS = ('upshift', 'upshift_light', 'upshift_full', 'upshift_2_3')
HANDED_OVER = 50
"""First step of the inertia phase."""


def worn(scenario: str, wear_gain: float) -> RunSettings:
    """Return a shift whose on-coming clutch has a wear gain."""
    return RunSettings(shift_settings(scenario).known, CaseSettings(wear_gain=wear_gain))


def carried_over_requested(ticks: list[Tick], settings: RunSettings) -> float:
    """Return what the on-coming clutch carries over what it is meant to, without the reserve."""
    on_coming = ticks[-1].command.on_coming
    meant = 100.0
    return settings.case.wear_gain * on_coming.request(meant) / meant


@pytest.mark.parametrize('scenario', SHIFTS)
@pytest.mark.parametrize('wear_gain', WEAR)
def test_a_worn_clutch_carries_what_it_is_meant_to_without_flare_and_tie_up(scenario, wear_gain):
    settings = worn(scenario, wear_gain)
    ticks = shift(settings, 'adaptive')
    assert carried_over_requested(ticks, settings) == pytest.approx(1.0, abs=0.12)
    assert flare(ticks) < 8.0
    assert tie_up_work(ticks) < 75.0


@pytest.mark.parametrize('wear_gain', [0.85, 1.15])
def test_an_engine_that_cannot_give_the_demand_is_not_taken_for_wear(wear_gain):
    # It gives 300 N m at the highest speed alone.
    full_load = [0.0, 110.0, 170.0, 225.0, 250.0, 217.0, 165.0, 300.0]
    beyond = {'engine.torque_n_m': [300.0], 'engine_limits.full_load_n_m': full_load}
    scenario = load_scenario('upshift_full', beyond)
    known = replace(shift_settings('upshift_full').known, scenario=scenario)
    settings = RunSettings(known, CaseSettings(wear_gain=wear_gain))
    ticks = shift(settings, 'adaptive')
    assert carried_over_requested(ticks, settings) == pytest.approx(1.0, abs=0.05)


def test_a_worn_clutch_flares_and_ties_up_without_the_measurement():
    assert flare(shift(worn('upshift', 0.7), 'model')) > 15.0
    assert tie_up_work(shift(worn('upshift_full', 1.3), 'model')) > 60.0


def test_the_kiss_point_of_a_hot_clutch_is_found(monkeypatch):
    """Both clutches carry 18 N m more than requested; the reserve would add to them."""
    monkeypatch.setattr(adaptive, 'RESERVE', 0.0)
    hot = shift_settings('upshift_hot')
    ticks = shift(hot, 'adaptive')
    assert ticks[HANDED_OVER].command.torque_offset > 9.0
    assert tie_up_work(ticks) < 0.6 * tie_up_work(shift(hot, 'model'))


def test_the_reserve_fades_after_the_handover():
    settings = shift_settings('upshift')
    ticks = shift(settings, 'adaptive')
    faded = HANDED_OVER + steps_in('RESERVE_FADES_S', RESERVE_FADES_S)
    gains = [1.0 + tick.command.wear_deviation for tick in ticks[HANDED_OVER:]]
    estimate = gains[-1]
    assert gains[0] == pytest.approx((1.0 - RESERVE) * estimate)
    assert gains[: faded - HANDED_OVER + 1] == sorted(gains[: faded - HANDED_OVER + 1])
    assert set(gains[faded - HANDED_OVER :]) == {estimate}
    assert {tick.command.torque_offset for tick in ticks[HANDED_OVER:]} == {
        ticks[-1].command.torque_offset
    }


def test_a_longer_handover_finds_the_wear_better():
    errors = [
        abs(ticks[-1].command.wear_deviation + 0.25)
        for ticks in (
            shift(
                replace(
                    shift_settings('upshift', handover_s=seconds),
                    case=CaseSettings(wear_gain=0.75),
                ),
                'adaptive',
            )
            for seconds in (0.05, 0.6)
        )
    ]
    assert errors[1] < 0.03 < errors[0]


@pytest.mark.parametrize('mass_kg', [1200.0, 1950.0])
@pytest.mark.parametrize('wear_gain', [0.75, 1.25])
def test_a_mass_that_is_not_known_moves_the_torque_by_less_than_five_percent(mass_kg, wear_gain):
    settings = worn('upshift_full', wear_gain)
    car = load_scenario('upshift_full', {'vehicle.mass_kg': mass_kg})
    other = RunSettings(replace(settings.known, scenario=car))
    known, unknown = (
        carried_over_requested(shift(other, 'adaptive', law=AdaptiveHandover(each.known)), other)
        for each in (other, settings)
    )
    assert unknown == pytest.approx(known, abs=0.05)


class LosesSamples(Handover):
    """The handover `adaptive`, whose engine speed sometimes stays as it was far before."""

    def __init__(self, settings: RunSettings) -> None:
        """Make the handover."""
        super().__init__(settings.known)
        self._law = AdaptiveHandover(settings.known)

    def update(self, measurement: HandoverMeasurement) -> HandoverCommand:
        """Return the command for the period of t_k."""
        if measurement.step in (12, 37, 41):
            lost = measurement.engine_speed - 6.0
            measurement = measurement._replace(
                engine_speed=lost, off_going_slip=measurement.off_going_slip - 6.0
            )
        return self._law.update(measurement)


def test_a_lost_sample_of_a_sensor_does_not_end_the_estimate():
    settings = worn('upshift', 0.75)
    ticks = shift(settings, 'adaptive', law=LosesSamples(settings))
    assert carried_over_requested(ticks, settings) == pytest.approx(1.0, abs=0.12)


def test_the_request_is_made_for_a_bounded_wear_gain():
    ticks = shift(worn('upshift', 3.0), 'adaptive')
    deviations = [tick.command.wear_deviation for tick in ticks]
    assert max(deviations) == pytest.approx(MOST_GAIN - 1.0)


def test_nothing_known_leaves_a_request_as_it_is():
    for torque in (0.1, 123.4567890123, -3.3):
        assert WHOLE.request(torque) == torque
    assert OnComingShare(1.0, -0.2, 10.0).request(90.0) == pytest.approx(100.0)
