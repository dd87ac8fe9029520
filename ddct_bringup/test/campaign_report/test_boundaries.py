"""Where failure begins, on the way out from the nominal value to both sides."""

import numpy as np
from made_results import made_results

from ddct_bringup.campaign_report.outcome import WayOut, ways_out
from ddct_bringup.campaign_report.summary import summary_of
from ddct_bringup.verdict.state import ENGAGED, INVALID

WEAR = [0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3]


def found(outcomes, start=1.0, values=WEAR):
    return ways_out(np.array(values), np.array(outcomes, dtype=object), start)


def by_mark(marks):
    """Return outcomes written as a row of letters."""
    return [{'e': ENGAGED, 'f': 'failed', 'i': INVALID}[mark] for mark in marks]


def test_the_first_failure_is_the_one_next_to_what_held_and_not_the_last():
    ways = found(by_mark('efeeeeff'))
    assert ways['below'] == WayOut(held_to=0.8, first_failure=0.7, row=1, lost=1, runs=1)
    assert ways['above'] == WayOut(held_to=1.1, first_failure=1.2, row=6, lost=1, runs=1)


def test_without_a_failure_it_held_to_the_ends_of_the_range():
    ways = found(by_mark('eeeeeeee'))
    assert (ways['below'].held_to, ways['below'].first_failure) == (0.6, None)
    assert (ways['above'].held_to, ways['above'].first_failure) == (1.3, None)


def test_a_start_that_fails_is_the_first_failure_of_both_ways():
    ways = found(by_mark('eeeefeee'))
    assert ways['below'] == ways['above'] == WayOut(None, 1.0, 4, 1, 1)


def test_where_all_fail_nothing_held():
    assert found(by_mark('ffffffff'))['below'] == WayOut(None, 1.0, 4, 1, 1)


def test_an_invalid_run_holds_nothing():
    assert found(by_mark('eeeeeiee'))['above'] == WayOut(1.0, 1.1, 5, 1, 1)


def test_a_value_with_several_runs_fails_with_one_and_a_failed_run_is_named_first():
    ways = found(by_mark('eeeif'), 1.0, [1.0, 1.0, 1.0, 1.1, 1.1])
    assert ways['above'] == WayOut(1.0, 1.1, 4, 2, 2)


def test_a_start_between_samples_takes_each_side_by_itself():
    ways = found(by_mark('eefe'), 1.0, [0.7, 0.9, 1.05, 1.2])
    assert (ways['below'].held_to, ways['below'].first_failure) == (0.7, None)
    assert ways['above'] == WayOut(None, 1.05, 2, 1, 1)


def test_one_run_is_enough():
    assert found([ENGAGED], values=[1.0])['below'] == WayOut(1.0, None, None)


def summary_over_wear_and_mass(states):
    wear, mass = [0.8, 0.9, 1.0] * 3, [1000.0] * 3 + [1400.0] * 3 + [1800.0] * 3
    varied = {'wear_gain': wear, 'vehicle.mass_kg': mass}
    nominal = {'wear_gain': 1.0, 'vehicle.mass_kg': 1500.0}
    return summary_of(made_results(states, varied, nominal=nominal))['groups'][0]


def test_on_a_grid_the_others_are_at_the_value_nearest_to_nominal():
    states = [ENGAGED] * 9
    states[0] = 'stalled'  # wear 0.8 at 1000 kg, on no way out
    states[4] = 'runaway'  # wear 0.9 at 1400 kg
    states[8] = 'not_engaged'  # 1800 kg at wear 1
    wear, mass = summary_over_wear_and_mass(states)['first_failures']
    assert (wear['start'], wear['others']) == (1.0, {'vehicle.mass_kg': 1400.0})
    assert wear['below'] == {
        'held_to': 1.0,
        'first_failure': 0.9,
        'lost': 1,
        'runs': 1,
        'index': 4,
        'state': 'runaway',
    }
    assert wear['above']['first_failure'] is None
    assert (mass['nominal'], mass['start']) == (1500.0, 1400.0)
    assert (mass['above']['first_failure'], mass['above']['held_to']) == (1800.0, 1400.0)
    assert (mass['below']['first_failure'], mass['below']['held_to']) == (None, 1000.0)


def test_of_random_samples_the_way_starts_at_the_nominal_value():
    results = made_results(
        [ENGAGED, 'stalled', ENGAGED],
        {'wear_gain': [0.95, 0.8, 1.2]},
        random=['wear_gain'],
        nominal={'wear_gain': 1.0},
    )
    (wear,) = summary_of(results)['groups'][0]['first_failures']
    assert wear['start'] == 1.0
    assert (wear['below']['held_to'], wear['below']['first_failure']) == (0.95, 0.8)
    assert (wear['above']['held_to'], wear['above']['first_failure']) == (1.2, None)


def test_a_number_that_the_scenario_has_not_starts_at_the_value_nearest_to_zero():
    results = made_results([ENGAGED, 'runaway'], {'sensors.delay_s': [0.01, 0.02]})
    (delay,) = summary_of(results)['groups'][0]['first_failures']
    assert (delay['nominal'], delay['start']) == (None, 0.01)
    assert delay['above']['first_failure'] == 0.02
