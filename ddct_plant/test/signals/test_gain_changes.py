# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Changes of gains are recorded where they first act, and are read from statuses to the bit."""

import pytest

from ddct_plant.base.errors import DdctError
from ddct_plant.signals.gain_changes import GainChange, GainRecord, changes_note, gain_changes

START = {'proportional_gain': 0.1, 'integral_gain': 0.02}
OTHER = (('feedback', 'on'), ('mine', '1 to 2 at 3 ns'))


def record(*changes: tuple[int, str, float], steps: int = 9) -> list[tuple[tuple[str, str], ...]]:
    """Return the statuses of a run whose gains are changed before these steps are computed."""
    gains, changed, statuses = dict(START), GainRecord(), []
    for step in range(steps):
        for at, name, value in changes:
            if at == step:
                changed.announce([name], gains)
                gains[name] = value
        changed.update(lambda: gains, step)
        statuses.append((*OTHER, *changed.pairs))
    return statuses


def test_a_change_is_read_as_it_was_recorded_to_the_last_bit() -> None:
    change = GainChange('proportional_gain', 0.1, 0.1 + 2e-17 + 0.2, 62)
    assert GainChange.of(change.pair) == change
    assert change.pair[1].endswith(' at 1620000000 ns')
    assert change.text == 'proportional_gain 0.1 to 0.3 at 0.62 s'


def test_a_run_without_a_change_has_the_statuses_of_before() -> None:
    assert record() == [OTHER] * 9
    assert gain_changes(record()) == ()
    assert changes_note(()) == ''


def test_every_change_of_a_run_is_found_in_order_that_back_included() -> None:
    statuses = record(
        (2, 'proportional_gain', 0.3), (4, 'integral_gain', 0.0), (7, 'proportional_gain', 0.1)
    )
    expected = (
        GainChange('proportional_gain', 0.1, 0.3, 2),
        GainChange('integral_gain', 0.02, 0.0, 4),
        GainChange('proportional_gain', 0.3, 0.1, 7),
    )
    assert gain_changes(statuses) == expected
    assert statuses[1] == OTHER
    assert [len(status) - len(OTHER) for status in statuses] == [0, 0, 1, 1, 2, 2, 2, 2, 2]
    # A real-time run may lack messages: those of a tick are not the only ones with its change.
    assert (
        gain_changes([each for k, each in enumerate(statuses) if k not in (2, 4, 7)]) == expected
    )


def test_changes_between_two_steps_are_the_one_that_acts() -> None:
    twice = record((3, 'proportional_gain', 0.3), (3, 'proportional_gain', 0.4))
    assert gain_changes(twice) == (GainChange('proportional_gain', 0.1, 0.4, 3),)
    back = record((3, 'proportional_gain', 0.3), (3, 'proportional_gain', 0.1))
    assert back == record()


def test_a_change_before_the_first_step_acts_from_it_on() -> None:
    (change,) = gain_changes(record((0, 'integral_gain', 0.5)))
    assert (change.step, change.time_s) == (0, 0.0)


@pytest.mark.parametrize(
    'value',
    [
        '',
        '0.1 to 0.3',
        'a to 0.3 at 1620000000 ns',
        '0.1 to nan at 1620000000 ns',
        '1 to 2 at 7 ns',
    ],
)
def test_a_change_that_cannot_be_read_is_named(value: str) -> None:
    with pytest.raises(DdctError, match='controller/status has .changed gains.kp.') as refused:
        gain_changes([(('changed gains.kp', value),)])
    assert '\n' not in str(refused.value)
