# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Bags of made-up runs: random numbers in every signal, so that no two values are alike."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from edited_settings import edited  # noqa: F401

from ddct_bringup.bag.reader import mcap_of
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.bag.writer import BagWriter
from ddct_plant.bag_file.records import read_records
from ddct_plant.models.driveline import PhaseEvent
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.recorded_settings import SETTINGS, RecordedSettings
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.signals import topics
from ddct_plant.signals.topic import RunKind
from ddct_plant.signals.topics import recorded_topics

RUN_INFO = {'/load': {'version': '1.0'}, '/engine': {'version': '1.0', 'two_input': 'false'}}


def described(steps, controller='pi', *, scenario='made-up', **changes):
    """Return the custom data of a run of `steps` steps that is scored over its last half."""
    duration = steps / 100.0
    times = {
        'duration_s': duration,
        'control_start_s': 0.1,
        'score_window_s': [round(duration / 2.0, 2), duration],
    }
    times = {name: changes.pop(name, value) for name, value in times.items()}
    clutch = changes.pop('clutch', 'linear')
    made = replace(load_scenario('thesis', {**times, 'clutch': clutch}), name=scenario)
    settings = RunSettings.of(made, changes)
    return {SETTINGS: RecordedSettings.of(settings, controller, times['duration_s']).text()}


def random_trajectory(steps, preview_steps=2, clutch='linear'):
    """Return a run of random numbers."""
    run = RunKind(clutch=clutch)
    random = np.random.default_rng(steps)
    widths = {
        'joint_position': (4,),
        'joint_speed': (4,),
        'joint_effort': (4,),
        'slip_reference': (preview_steps + 1,),
        'slip_reference_rate': (preview_steps + 1,),
        'actuator_torque': (11,),
        'clutch_torque': (11,),
        'clutch_static_torque': (11,),
    }
    arrays: dict[str, Any] = {
        signal.name: random.normal(0.0, 100.0, (steps + 1, *widths.get(signal.name, ())))
        for topic in recorded_topics(run)
        for signal in topic.signals_in(run)
        if signal.unit
    }
    if run.clutch != 'linear':
        arrays['clutch_phase'] = random.integers(0, 3, steps + 1).astype(float)
    status = tuple(
        (('part_n_m', repr(float(value))), ('saturated', 'true' if value < 0.0 else 'false'))
        for value in random.normal(0.0, 100.0, steps + 1)
    )
    texts: dict[str, Any] = {'status': status}
    if run.clutch != 'linear':
        events = ((PhaseEvent(0.25, 'lock', -200.0 / 3.0), PhaseEvent(1.0 / 3.0, 'release')), ())
        texts['phase_events'] = tuple(events[step % 2] for step in range(steps + 1))
    return Trajectory.of_columns({**arrays, **texts})


class Bags:
    """Writer of test bags below one folder."""

    def __init__(self, folder: Path):
        self.folder = folder

    def write(self, trajectory, name='pi', folder=None, **changes):
        """Write a run as the recorder would, and return the bag's folder."""
        from ddct_bringup.bag.trajectory_bag import write_trajectory

        bag = self.folder / (folder or name)
        custom_data = described(trajectory.steps, name, **changes)
        write_trajectory(trajectory, bag, name, custom_data, RUN_INFO)
        return bag

    def rewrite(self, source, folder, edit=lambda messages: messages, /, **changes):
        """
        Write the messages of a bag again, edited, as a list of (topic, stamp, bytes).

        `changes` are those of `edited`.
        """
        records = read_records(mcap_of(source))
        bag = self.folder / folder
        known = {topic.resolved_name: topic for topic in topics.TOPICS}
        written = [known[channel.topic] for channel in records.channels.values()]
        with BagWriter(bag, folder, written, edited(records.custom_data, **changes)) as writer:
            for message in edit(list(records.messages())):
                writer.write(*message)
        return bag


@pytest.fixture
def bags(tmp_path):
    return Bags(tmp_path)


@pytest.fixture
def trajectory():
    """Return a run of 0.6 s: more than two chunks of messages."""
    return random_trajectory(60)


@pytest.fixture
def make_trajectory():
    return random_trajectory
