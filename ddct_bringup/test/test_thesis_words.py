"""The words of Table 5.2, by the order that they imply."""

from types import SimpleNamespace

import pytest

from ddct_bringup.thesis.words import oscillation_word, slip_word


@pytest.mark.parametrize(
    ('name', 'word'),
    [('hinf2', 'good'), ('ls8', 'bad'), ('mpc3', 'bad'), ('mpc4', 'average')],
)
def test_average_slip_is_between_good_and_the_better_of_the_bad(name, word):
    slips = {'hinf2': 2.9, 'ls8': 30.0, 'mpc3': 20.0, 'mpc4': 19.9}
    assert slip_word(name, slips) == word


@pytest.mark.parametrize(('slip', 'word'), [(3.0, 'average'), (20.0, 'bad'), (2.99, 'good')])
def test_slip_on_a_limit_belongs_to_the_worse_word(slip, word):
    assert slip_word('mpc4', {'ls8': 30.0, 'mpc3': 20.0, 'mpc4': slip}) == word


def oscillation(torsion, acceleration):
    sigmas = {'ls8': (1.0, 0.4), 'hinf2': (5.0, 0.2), 'mpc3': (torsion, acceleration)}
    metrics = {
        name: SimpleNamespace(torsion_speed_std_rpm=first, acceleration_std_m_s2=second)
        for name, (first, second) in sigmas.items()
    }
    return oscillation_word('mpc3', metrics)


@pytest.mark.parametrize(
    ('torsion', 'acceleration', 'word'),
    [
        (2.0, 0.3, 'average'),
        (0.9, 0.1, 'low'),
        (5.1, 0.5, 'high'),
        (2.0, 0.1, 'average, low'),
        (None, 0.3, 'high, average'),
    ],
)
def test_average_oscillation_is_between_ls8_and_hinf2_whichever_is_larger(
    torsion, acceleration, word
):
    assert oscillation(torsion, acceleration) == word
