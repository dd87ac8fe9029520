# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A sample of the fault campaign ends as stated; `make faults` tries all of its cases."""

from dataclasses import replace

import pytest
from faults.campaign.__main__ import attempt_in_time
from faults.campaign.all_cases import all_cases
from faults.campaign.case import LATEST, Case
from faults.campaign.outcome import NEVER, RUNS_ON, SAME, Observed, named, safe_state
from faults.campaign.records import read_records, record_of
from generator.fault_tables import RECORDS

from ddct_plant.signals.topics import TOPICS

SAMPLE = (
    'node killed, load, start, lockstep, one clutch',
    'node stopped for 0.5 s, off_going/clutch, middle, lockstep, two clutches',
    'node stopped for good, controller, middle, realtime, one clutch',
    'node restarted, actuator, middle, lockstep, one clutch',
    'message dropped, each topic to controller, middle, lockstep, one clutch',
    'message reordered, each topic to handover, middle, lockstep, two clutches',
    'message delayed, each topic to recorder, middle, realtime, one clutch',
    'stamp off the grid, clutch/torque, middle, lockstep, one clutch',
    'second publisher, clutch/torque, middle, lockstep, one clutch',
    'another type, load/torque, start, realtime, one clutch',
    'value 1e308, sensors/slip, middle, realtime, two clutches',
    'node killed, clutch, middle, realtime, one clutch',
    'value NaN, off_going/clutch/torque_request, middle, lockstep, two clutches',
    '10 MB array, clutch/torque, middle, lockstep, one clutch',
    'killed by SIGKILL, bringup, start, lockstep, one clutch',
)


@pytest.mark.slow
@pytest.mark.parametrize('name', SAMPLE)
def test_a_fault_ends_as_stated_and_leaves_nothing(name: str) -> None:
    (case,) = [each for each in all_cases() if each.name == name]
    as_stated, seen, tries = attempt_in_time(case)
    assert not seen.left
    if not as_stated and _too_busy(case, seen):
        pytest.skip(f'too busy for real time in {tries} tries: {seen.summary()}')
    assert as_stated, f'{seen.summary()}; stated: {case.stated.text}'


def _too_busy(case: Case, seen: Observed) -> bool:
    """Return whether a real-time run was disturbed before its fault, or over: nothing is tried."""
    too_late = not case.in_time(seen) and (not seen.error or case.stated.met(seen))
    return case.mode == 'realtime' and (too_late or (seen.disturbed_before and not seen.error))


def test_a_case_in_real_time_is_left_out_only_where_the_machine_disturbed_it_before() -> None:
    (case,) = [each for each in all_cases() if each.name == SAMPLE[2]]
    seen = Observed(fault_step=case.begin, steps=case.steps, planned=case.steps)
    assert not _too_busy(case, seen)
    assert not _too_busy(case, replace(seen, safe={'/actuator': 16})), 'for no missed step'
    assert not _too_busy(case, replace(seen, safe={'/actuator': case.begin + 40}, missed=3))
    opened = replace(seen, safe={'/actuator': 16}, missed=3)
    assert _too_busy(case, opened)
    assert not _too_busy(case, replace(opened, error='node load was killed'))
    assert not _too_busy(replace(case, mode='lockstep'), opened)
    late = replace(seen, fault_step=NEVER)
    assert _too_busy(case, late)
    assert not _too_busy(case, replace(late, error='node load was killed'))


def test_the_kept_records_are_of_the_cases_and_outcomes_that_the_campaign_has() -> None:
    records = read_records(RECORDS)
    kept = {name: record['stated'] for name, record in records.items()}
    assert kept == {case.name: case.stated.text for case in all_cases()}
    assert [
        name for name, each in records.items() if not (each['tries'] and each['as_stated'])
    ] == []


def test_the_topics_of_the_campaign_are_those_of_the_project() -> None:
    targets = {case.target for case in all_cases() if case.fault == 'another type'}
    assert {topic.name for topic in TOPICS} == targets


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
    ended = replace(opened, error='node controller has shown no sign of life for 3 s')
    assert safe_state('actuator', stopped='controller').met(ended)
    assert not safe_state('actuator', stopped='reference').met(ended)
    assert not safe_state('actuator').met(ended)
    opened.safe = {'/actuator': 7}
    assert not safe_state('actuator', within_s=0.1).met(opened), 'long before the fault'


def test_other_values_need_a_reason_in_real_time() -> None:
    other = Observed(steps=100, planned=100, complete=True)
    assert not RUNS_ON.met(other)
    assert RUNS_ON.met(replace(other, missed=1))
    assert RUNS_ON.met(replace(other, complete=False))
    assert RUNS_ON.met(replace(other, same_hash=True))
    assert not RUNS_ON.met(replace(other, error='load: no load/torque', missed=1))


def test_an_end_in_time_is_not_met_by_a_later_one() -> None:
    ended = Observed(error='node load was killed', fault_step=68, steps=90, planned=160)
    assert named('load', within_s=0.3).met(ended)
    assert not named('load', within_s=0.2).met(ended)


def test_a_fault_that_came_late_or_never_is_not_as_stated() -> None:
    (case,) = [each for each in all_cases() if each.name == SAMPLE[1]]
    seen = Observed(fault_step=case.begin, steps=case.steps, planned=case.steps, same_hash=True)
    assert case.met(seen)
    assert not case.met(replace(seen, fault_step=NEVER))
    live = replace(case, mode='realtime', stated=RUNS_ON)
    assert live.met(seen)
    assert not live.met(replace(seen, fault_step=case.begin + LATEST + 1))
