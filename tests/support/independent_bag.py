# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Signals of a bag by the MCAP library and its ROS 2 decoder, without any code of ours.

What a topic holds is read from docs/develop/graph.md alone. All values are SI.
"""

import json
from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

PERIOD_S = 0.01
START_NS = 1_000_000_000
PERIOD_NS = 10_000_000
LOCK, RELEASE = 'lock', 'release'
_EVENTS = (LOCK, RELEASE, 'reverse')


@dataclass(frozen=True)
class Event:
    """A lock, a release or a passage through zero slip, within a period."""

    kind: str
    time_s: float
    """Exact scenario time."""
    step: int
    """Step at the end of the period that it is in."""


@dataclass(frozen=True)
class IndependentBag:
    """Messages of a bag by topic, one for each step, and the settings of the run."""

    messages: dict[str, list[Any]]
    known: dict[str, Any]
    """Settings of the run that controllers know, in `metadata.yaml`."""

    @classmethod
    def read(cls, bag: Path) -> 'IndependentBag':
        """Read a bag, given by its folder or by the file in it."""
        folder = bag if bag.is_dir() else bag.parent
        text = (folder / 'metadata.yaml').read_text(encoding='utf-8')
        loader = getattr(yaml, 'CSafeLoader', yaml.SafeLoader)
        information = yaml.load(text, loader)['rosbag2_bagfile_information']
        messages: dict[str, list[Any]] = defaultdict(list)
        with (folder / information['relative_file_paths'][0]).open('rb') as stream:
            reader = make_reader(stream, decoder_factories=[DecoderFactory()])
            for _, channel, entry, message in reader.iter_decoded_messages():
                if channel.topic.endswith('run_info'):
                    continue
                of_topic = messages[channel.topic]
                assert entry.log_time == START_NS + len(of_topic) * PERIOD_NS, channel.topic
                of_topic.append(message)
        assert len({len(of_topic) for of_topic in messages.values()}) == 1
        return cls(dict(messages), json.loads(information['custom_data']['settings'])['known'])

    @cached_property
    def scenario(self) -> dict[str, Any]:
        """Scenario of the run, nested."""
        return self.known['scenario']

    @property
    def steps(self) -> int:
        """Number of periods of the run."""
        return len(self.messages['/clutch/slip']) - 1

    @property
    def planned_steps(self) -> int:
        """Number of periods that the run should have had."""
        return round(self.known['duration_s'] / PERIOD_S)

    @property
    def start(self) -> int:
        """Step of control start; in a gear shift that of its start."""
        return round(self.scenario['control_start_s'] / PERIOD_S)

    @property
    def sticks(self) -> bool:
        """Whether the plates can lock."""
        return '/clutch/phase' in self.messages

    @property
    def shift(self) -> bool:
        """Whether the run is a gear shift."""
        return '/clutch/handover_share' in self.messages

    @property
    def commands_engine(self) -> bool:
        """Whether the controller commands the engine."""
        return '/engine/torque_request' in self.messages

    def _values(self, topic: str, take: Any) -> np.ndarray:
        return np.array([take(message) for message in self.messages[topic]], dtype=float)

    def torque(self, topic: str) -> np.ndarray:
        """Return the torques of a topic of `WrenchStamped`, (N+1,); each acts for a period."""
        return self._values(topic, lambda message: message.wrench.torque.x)

    def joint(self, name: str, field: str, topic: str = '/driveline/joint_states') -> np.ndarray:
        """Return `velocity` or `effort` of a joint, (N+1,)."""
        index = list(self.messages[topic][0].name).index(name)
        return self._values(topic, lambda message: getattr(message, field)[index])

    @cached_property
    def acceleration(self) -> np.ndarray:
        """A_x in m/s^2, (N+1,)."""
        return self._values('/vehicle/accel', lambda message: message.accel.linear.x)

    @cached_property
    def slip(self) -> np.ndarray:
        """w_d in rad/s, (N+1,)."""
        return self._values('/clutch/slip', lambda message: message.twist.angular.x)

    @cached_property
    def share(self) -> np.ndarray:
        """Share of the open loop that the on-coming clutch carries, (N+1,)."""
        return self._values('/clutch/handover_share', lambda message: message.vector.x)

    def _pairs(self, topic: str) -> list[list[tuple[str, str]]]:
        return [
            [(pair.key, pair.value) for pair in message.status[0].values]
            for message in self.messages[topic]
        ]

    def of_phase(self, key: str, topic: str = '/clutch/phase') -> list[str]:
        """Return the text of a key of each message of `clutch/phase`."""
        return [dict(pairs)[key] for pairs in self._pairs(topic)]

    def work(self, key: str, topic: str = '/clutch/phase') -> np.ndarray:
        """Return the work in J of the period that ends at each step, (N+1,)."""
        return np.array([float(text) for text in self.of_phase(key, topic)])

    def events(self, topic: str = '/clutch/phase') -> list[Event]:
        """Return all events of a clutch in order of time."""
        return [
            Event(key, float(value), step)
            for step, pairs in enumerate(self._pairs(topic))
            for key, value in pairs
            if key in _EVENTS
        ]
