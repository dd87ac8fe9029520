# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The table of `compare`: computed scores, and those of the thesis under its conditions only."""

import dataclasses
import io

import pytest
from made_scores import made_scores
from printed_table import value_under

from ddct_bringup.scores.comparison_table import print_comparison
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

THESIS = load_scenario('thesis')
SLOPE = 'load.slope_rad=0.05'
OURS = {
    'engagement_time_s': 0.111,
    'torsion_speed_std_rpm': 2.222,
    'acceleration_std_m_s2': 0.333,
    'slip_final_rpm': -4.44,
    'peak_jerk_m_s3': 5.52,
}


def entry(controller='ls8', *, valid=True):
    reason = '' if valid else 'node clutch was killed'
    return made_scores(controller, valid=valid, reason=reason, **OURS)


def printed(settings=None, overrides=(), runs=()):
    stream = io.StringIO()
    print_comparison(
        runs or [entry('ls8'), entry('mpc4')],
        settings or RunSettings(KnownSettings(THESIS)),
        overrides,
        stream,
    )
    return stream.getvalue()


@pytest.mark.parametrize('worn', [False, True])
@pytest.mark.parametrize(
    ('heading', 'alone', 'unit', 'value'),
    # The heading beside the values of the thesis is wrapped.
    [
        ('t_a s', 't_a s', 'ours', '0.111'),
        ('std w_sr', 'std w_sr rpm', 'ours', '2.222'),
        ('std A_x', 'std A_x m/s^2', 'ours', '0.333'),
        ('final', 'final', 'rpm', '-4.4'),
        ('jerk', 'jerk', 'm/s^3', '5.5'),
    ],
)
def test_computed_values_are_below_their_headings(heading, alone, unit, value, worn):
    text = printed(
        RunSettings(KnownSettings(THESIS), CaseSettings(wear_gain=0.7)) if worn else None
    )
    assert value_under(text, alone if worn else heading, 'ls8') == (unit, value)


@pytest.mark.parametrize(
    ('controller', 'printed_figures'),
    # As Table 5.1 prints them: t_a, the deviation of w_sr, that of A_x.
    [('ls8', ['0.71', '1.15', '0.20']), ('mpc4', ['0.52', '0.20', '0.06'])],
)
def test_each_value_of_the_thesis_is_right_of_the_computed_one(controller, printed_figures):
    text = printed()
    names = next(line for line in text.splitlines() if 'ours' in line)
    shown = [value_under(text, 'thesis', controller, place) for place in range(3)]
    assert shown == [('thesis', figure) for figure in printed_figures]
    assert names.split()[1:7] == 3 * ['ours', 'thesis']


@pytest.mark.parametrize(
    ('settings', 'overrides'),
    [
        (RunSettings(KnownSettings(THESIS), CaseSettings(wear_gain=0.7)), ()),
        (RunSettings(KnownSettings(THESIS), CaseSettings(wear_gain=1.3)), ()),
        (RunSettings(KnownSettings(THESIS, architecture='feedforward')), ()),
        (RunSettings(KnownSettings(dataclasses.replace(THESIS, name='mine'))), ()),
        (RunSettings(KnownSettings(load_scenario('thesis', [SLOPE]))), (SLOPE,)),
    ],
    ids=['worn', 'thicker', 'architecture', 'scenario', 'changed scenario'],
)
def test_the_thesis_is_shown_beside_its_own_conditions_only(settings, overrides):
    text = printed(settings, overrides).partition('\n')[2]
    assert 'thesis' not in text
    assert 'calibrated' not in text
    assert '0.71' not in text


def test_a_run_that_is_not_valid_neither_hits_nor_misses():
    table, _, _ = printed(runs=[entry('mpc4')]).partition('thesis: Table 5.1.')
    assert 'miss' in table
    table, _, _ = printed(runs=[entry('mpc4', valid=False)]).partition('thesis: Table 5.1.')
    assert 'hit' not in table
    assert 'miss' not in table
    assert 'mpc4: not valid: node clutch was killed' in table


@pytest.mark.parametrize(
    ('overrides', 'title'),
    [
        ((), 'thesis; detailed, wear gain 1, lockstep'),
        ((SLOPE,), f'thesis, 1 value changed: {SLOPE}; detailed, wear gain 1'),
    ],
)
def test_the_title_lists_the_changes_of_the_packaged_scenario(overrides, title):
    text = printed(RunSettings(KnownSettings(load_scenario('thesis', overrides))), overrides)
    assert title in ' '.join(text.split())


def test_the_title_of_a_scenario_of_ones_own_has_what_set_gave():
    own = dataclasses.replace(load_scenario('thesis', [SLOPE]), name='mine')
    assert f'mine, 1 value changed: {SLOPE}; ' in ' '.join(
        printed(RunSettings(KnownSettings(own)), [SLOPE]).split()
    )
