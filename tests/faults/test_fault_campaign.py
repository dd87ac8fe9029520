# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A sample of the fault campaign ends as stated; `make faults` tries all of its cases."""

import pytest
from faults.campaign.__main__ import attempt_in_time
from faults.campaign.all_cases import all_cases
from faults.campaign.case import SAME, Observed, named, safe_state
from faults.campaign.records import read_records, record_of
from generator.fault_tables import RECORDS

SAMPLE = (
    'node killed, load, start, lockstep, one clutch',
    'node stopped for 0.5 s, off_going/clutch, middle, lockstep, two clutches',
    'node stopped for good, controller, middle, realtime, one clutch',
    'node restarted, actuator, middle, lockstep, one clutch',
    'message dropped, each topic to controller, middle, lockstep, one clutch',
    'message reordered, each topic to handover, middle, lockstep, two clutches',
    'stamp off the grid, clutch/torque, middle, lockstep, one clutch',
    'second publisher, clutch/torque, middle, lockstep, one clutch',
    'another type, load/torque, middle, lockstep, one clutch',
    'value NaN, off_going/clutch/torque_request, middle, lockstep, two clutches',
    '10 MB array, clutch/torque, middle, lockstep, one clutch',
    'killed by SIGKILL, bringup, start, lockstep, one clutch',
)


@pytest.mark.slow
@pytest.mark.parametrize('name', SAMPLE)
def test_a_fault_ends_as_stated_and_leaves_nothing(name: str) -> None:
    (case,) = [each for each in all_cases() if each.name == name]
    as_stated, seen, _ = attempt_in_time(case)
    assert as_stated, f'{seen.summary()}; stated: {case.stated.text}'


def test_the_kept_records_are_of_the_cases_and_outcomes_that_the_campaign_has() -> None:
    kept = {name: record['stated'] for name, record in read_records(RECORDS).items()}
    assert kept == {case.name: case.stated.text for case in all_cases()}


def test_records_have_no_paths_of_one_machine() -> None:
    case = all_cases()[0]
    where = 'build/ddct_controllers/ddct_controllers/linear.py line 3'
    for error, kept in (
        (
            f'mend it, in /home/me/ddct/{where}',
            'mend it, in ddct_controllers/ddct_controllers/linear.py line 3',
        ),
        ('/tmp/faults-x1_y/run/pi_0.mcap: gone', 'pi_0.mcap: gone'),
    ):
        assert record_of(case, Observed(error=error), True, 1)['outcome'] == kept


def test_an_outcome_is_met_by_what_it_states_alone() -> None:
    whole = Observed(same_hash=True, steps=100, planned=100, complete=True)
    other = Observed(steps=100, planned=100, complete=True)
    assert SAME.met(whole)
    assert not SAME.met(other)
    early = Observed(error='load: no load/torque', steps=40, planned=100)
    assert named('load/torque').met(early)
    assert not named('engine/torque').met(early)
    early.complete = True
    assert not named('load/torque').met(early), 'a half recording that counts'
    opened = Observed(fault_step=60, steps=100, planned=100, safe={'/actuator': 66})
    assert safe_state('actuator', within_s=0.1).met(opened)
    assert not safe_state('actuator', within_s=0.05).met(opened)
    assert not safe_state('driveline', within_s=0.1).met(opened)
