# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Labels of the report distinguish runs, and are no longer than needed."""

from made_scores import made_scores

from ddct_bringup.report.run_labels import common_conditions, run_labels
from ddct_bringup.scores.scoring import run_without_score


def test_controllers_in_the_same_conditions_go_by_their_names():
    runs = [made_scores('pi'), made_scores('ls8')]
    assert run_labels(runs) == ['pi', 'ls8']
    assert common_conditions(runs) == [
        'detailed',
        'wear 1',
        'lockstep',
        'seed 0',
    ]


def test_wear_gains_and_architectures_are_named_where_runs_differ_in_them():
    runs = [
        made_scores(wear_gain=0.7),
        made_scores(wear_gain=1.3),
        made_scores(wear_gain=1.3, architecture='feedforward'),
    ]
    assert run_labels(runs) == [
        'pi, detailed, wear 0.7',
        'pi, detailed, wear 1.3',
        'pi, feedforward, wear 1.3',
    ]
    assert common_conditions(runs) == ['lockstep', 'seed 0']


def test_logs_are_called_measured_and_their_number_is_among_the_conditions():
    log = made_scores('drive', architecture='measured', mode='measured')
    assert run_labels([made_scores(), log]) == ['pi', 'drive, measured']
    assert run_labels([made_scores(), made_scores(wear_gain=0.7), log])[1:] == [
        'pi, wear 0.7',
        'drive, measured',
    ]
    assert common_conditions([made_scores(), log])[-1] == '1 log of a car'
    assert common_conditions([made_scores(), log])[:2] == ['detailed', 'wear 1']
    assert common_conditions([log, log]) == ['2 logs of a car']


def test_the_same_run_twice_is_labelled_with_the_bag():
    runs = [made_scores(bag='new/pi'), made_scores(bag='old/pi'), made_scores('ls8')]
    assert run_labels(runs) == ['pi (new/pi)', 'pi (old/pi)', 'ls8']


def test_labels_are_never_the_same():
    assert run_labels([made_scores(bag='a')] * 3) == ['pi (a)', 'pi (a) #2', 'pi (a) #3']


def test_a_bag_without_facts_is_labelled_by_its_name():
    unknown = run_without_score('broken/pi', None, 'damaged')
    assert run_labels([made_scores('ls8'), unknown]) == ['ls8', 'broken/pi']
    assert common_conditions([unknown]) == []
