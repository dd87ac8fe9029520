# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""No panel of the Foxglove layout stays empty, whatever bag of ours it shows."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from support.foxglove_layout import (
    NOT_FOR_PANELS,
    Messages,
    problems,
    read_layout,
    read_messages,
    used_topics,
)
from support.message_path import parse
from support.runs import expected, plan

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.description import custom_data
from ddct_bringup.run.plan import RunPlan
from ddct_plant.models.driveline import PHASES
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from ddct_plant.signals.topics import RUN_INFO, TOPICS

Record = Callable[[RunPlan], Messages]

EVENTS = ('phase_events', 'off_going_phase_events')
FACTS = custom_data(plan('pi').settings, 'made-up', 70)
SERIES: dict[tuple[str, str], Callable[[Trajectory], np.ndarray]] = {
    ('Plot!slip', 'slip w_d'): lambda run: run.slip_speed,
    ('Plot!slip', 'reference'): lambda run: run.slip_reference[:, 0],
    ('Plot!clutch_torque', 'clutch C_f, or capacity'): lambda run: run.clutch_torque[:, 0],
    ('Plot!clutch_torque', 'transmitted'): lambda run: run.joint_effort[:, 1],
    ('Plot!clutch_torque', 'temperature (stick-slip)'): lambda run: run.clutch_temperature,
    ('Plot!clutch_torque', 'actuator'): lambda run: run.actuator_torque[:, 0],
    ('Plot!clutch_torque', 'request'): lambda run: run.torque_request,
    ('Plot!clutch_torque', 'open-loop part'): lambda run: run.open_loop_torque,
    ('Plot!clutch_torque', 'closed-loop part'): lambda run: run.closed_loop_torque,
    ('Plot!engine_torque', 'engine C_m'): lambda run: run.engine_torque,
    ('Plot!engine_torque', 'demand'): lambda run: run.torque_demand,
    ('Plot!engine_torque', 'request (two-input)'): lambda run: run.engine_torque_request,
    ('Plot!engine_torque', 'load C_load'): lambda run: run.load_torque,
    ('Plot!engine_torque', 'holding (stick-slip)'): lambda run: run.holding_torque,
    ('Plot!speeds', 'engine w_m'): lambda run: run.joint_speed[:, 0],
    ('Plot!speeds', 'primary w_p'): lambda run: run.joint_speed[:, 1],
    ('Plot!speeds', 'wheel w_r'): lambda run: run.joint_speed[:, 2],
    ('Plot!driveshaft', 'speed w_sr'): lambda run: run.joint_speed[:, 3],
    ('Plot!driveshaft', 'angle theta_sr'): lambda run: run.joint_position[:, 3],
    ('Plot!vehicle', 'accel. A_x'): lambda run: run.vehicle_accel,
    ('Plot!vehicle', 'speed V_x'): lambda run: run.vehicle_speed,
    ('Plot!slip', 'off-going slip (shift)'): lambda run: run.off_going_slip_speed,
    ('Plot!clutch_torque', 'off-going transmitted (shift)'): lambda run: (
        run.off_going_transmitted_torque
    ),
    ('Plot!clutch_torque', 'off-going request (shift)'): lambda run: run.off_going_torque_request,
    ('Plot!clutch_torque', 'off-going actuator (shift)'): lambda run: (
        run.off_going_actuator_torque[:, 0]
    ),
    ('Plot!clutch_torque', 'off-going capacity (shift)'): lambda run: run.off_going_clutch_torque[
        :, 0
    ],
    ('Plot!clutch_torque', 'off-going temperature (shift)'): lambda run: (
        run.off_going_clutch_temperature
    ),
    ('Plot!engine_torque', 'torque cut (shift)'): lambda run: run.torque_cut,
    ('Plot!speeds', 'off-going shaft w_p1 (shift)'): lambda run: run.off_going_shaft_speed,
    ('Plot!slip', 'measured (sensors)'): lambda run: run.sensed_slip_speed,
    ('Plot!engine_torque', 'estimated C_m (sensors)'): lambda run: run.sensed_engine_torque,
    ('Plot!speeds', 'measured w_m (sensors)'): lambda run: run.sensed_joint_speed[:, 0],
    ('Plot!speeds', 'measured w_p (sensors)'): lambda run: run.sensed_joint_speed[:, 1],
    ('Plot!speeds', 'measured w_r (sensors)'): lambda run: run.sensed_joint_speed[:, 2],
    ('Plot!vehicle', 'measured V_x (sensors)'): lambda run: run.sensed_vehicle_speed,
    ('StateTransitions!controller', 'feedback'): lambda run: _told(run, 'feedback'),
    ('StateTransitions!controller', 'request saturated'): lambda run: _told(run, 'saturated'),
    ('StateTransitions!controller', 'clutch phase (stick-slip)'): lambda run: _phases(
        run.clutch_phase
    ),
    ('StateTransitions!controller', 'off-going clutch phase (shift)'): lambda run: _phases(
        run.off_going_clutch_phase
    ),
    ('StateTransitions!controller', 'share of the on-coming clutch (shift)'): lambda run: (
        run.handover_share
    ),
    ('StateTransitions!controller', 'measured slip (3: sample lost)'): lambda run: _levels(
        run.sensed_slip_held
    ),
    ('StateTransitions!controller', 'estimated C_m (3: sample lost)'): lambda run: _levels(
        run.sensed_torque_held
    ),
}
"""What each series shows, by the panel and label that its reader sees."""


def _told(run: Trajectory, key: str) -> np.ndarray:
    """Return a value of the controller's status at each step, (N+1,), as text."""
    return np.array([dict(pairs)[key] for pairs in run.status])


def _phases(numbers: np.ndarray) -> np.ndarray:
    """Return the phase of a clutch at each step, (N+1,), in words."""
    return np.array(PHASES)[numbers.astype(int)]


def _levels(flags: np.ndarray) -> np.ndarray:
    """Return the level of a status for each flag: 3 for a lost sample, else 0."""
    return np.where(flags, 3, 0)


def _shift(*changes: str) -> RunPlan:
    """Return a headless gear shift of 0.7 s."""
    given = ['duration_s=0.7', 'score_window_s=[0.3,0.6]', *changes]
    scenario = load_scenario('upshift', given)
    return RunPlan(RunSettings(KnownSettings(scenario)), 'pi', 'headless')


def _made_up_run() -> Trajectory:
    """Return a gear shift with sensors, of two inputs, with another number in each place."""
    run = expected(_shift('sensors={}'))
    random = np.random.default_rng(1)
    arrays = {
        name: random.normal(0.0, 100.0, np.shape(values))
        for name, values in run.signals.items()
        if name not in ('status', *EVENTS)
    }
    for name in ('sensed_slip_held', 'sensed_torque_held'):
        arrays[name] = random.integers(0, 2, run.steps + 1).astype(float)
    for name in ('clutch_phase', 'off_going_clutch_phase'):
        arrays[name] = random.integers(0, len(PHASES), run.steps + 1).astype(float)
    status = tuple(
        tuple((key, str(1000.0 * place + step)) for place, (key, _) in enumerate(pairs))
        for step, pairs in enumerate(run.status)
    )
    torques = random.normal(0.0, 100.0, run.steps + 1)
    return Trajectory(
        {
            **arrays,
            'status': status,
            'engine_torque_request': torques,
            **{name: getattr(run, name) for name in EVENTS},
        }
    )


def test_each_series_is_the_signal_that_its_label_names(tmp_path: Path) -> None:
    from ddct_bringup.bag.trajectory_bag import write_trajectory

    run = _made_up_run()
    facts = custom_data(_shift().settings, 'made-up', 70)
    write_trajectory(run, tmp_path, 'made-up', facts, {'/controller': {'two_input': 'true'}})
    bag = read_messages(tmp_path)
    drawn = {
        (panel, series['label']): series['value']
        for panel, config in read_layout()['configById'].items()
        for series in config.get('paths', [])
        if parse(series['value']).topic != '/diagnostics'
    }
    assert drawn.keys() == SERIES.keys()
    for place, value in drawn.items():
        path = parse(value)
        shown = [path.values(message)[0] for _, message in bag[path.topic]]
        assert [str(each) for each in shown] == [str(each) for each in SERIES[place](run)], place


@pytest.mark.parametrize('controller', ['pi', 'hinf1'])
def test_no_panel_is_empty_in_a_lock_step_bag(record: Record, controller: str) -> None:
    assert problems(read_layout(), record(plan(controller, 'headless'))) == []


def test_no_panel_is_empty_in_the_bag_of_a_clutch_that_sticks(record: Record) -> None:
    bag = record(plan('pi', 'headless', scenario='thesis_sticking'))
    assert '/clutch/phase' in bag
    assert problems(read_layout(), bag) == []


def test_no_panel_is_empty_in_the_bag_of_a_gear_shift(record: Record) -> None:
    bag = record(_shift())
    assert '/off_going/clutch/phase' in bag
    assert problems(read_layout(), bag) == []


def test_no_panel_is_empty_in_the_bag_of_a_two_input_controller(tmp_path: Path) -> None:
    from ddct_bringup.bag.trajectory_bag import write_trajectory

    trajectory = expected(plan('pi', duration_s=0.7))
    two_input = Trajectory(
        {**trajectory.signals, 'engine_torque_request': trajectory.engine_torque}
    )
    run_info = {'/controller': {'controller': 'made-up', 'two_input': 'true'}}
    write_trajectory(two_input, tmp_path, 'made-up', FACTS, run_info)
    bag = read_messages(tmp_path)
    assert '/engine/torque_request' in bag
    assert problems(read_layout(), bag) == []


def test_the_table_of_the_run_names_the_controller(record: Record) -> None:
    *_, (_, last) = record(plan('ls8', 'headless'))['/run_info']
    assert RUN_INFO.read(last)[1]['controller'] == 'ls8'


def test_every_topic_is_in_a_panel_or_has_a_reason_not_to_be() -> None:
    names = {topic.resolved_name for topic in TOPICS}
    assert used_topics(read_layout()) | set(NOT_FOR_PANELS) == names
