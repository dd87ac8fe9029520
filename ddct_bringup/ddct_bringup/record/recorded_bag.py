# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The bag of a run while it is recorded: opened once every node is known, written in order."""

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from rclpy.serialization import serialize_message

from ddct_bringup.bag.run_info import run_info_topic
from ddct_bringup.bag.writer import BagWriter
from ddct_bringup.record.run_info_collector import RunInfoCollector
from ddct_bringup.record.tick_buffer import Tick
from ddct_bringup.run.description import custom_data
from ddct_plant.bag_file.cdr import CdrNormaliser, stamp_of_cdr
from ddct_plant.bag_file.message_definitions import load_definition
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import START_NS, stamp_of_step
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.signals.topic import RunKind, Topic
from ddct_plant.signals.topics import RECORDER_ACK, RUN_INFO, recorded_topics


class RecordedBag:
    """Bag that is opened with the first tick after every node has published its `run_info`."""

    def __init__(
        self,
        path: tuple[Path, str],
        run: RunKind,
        settings: RunSettings,
        nodes: RunInfoCollector,
        acknowledge: Callable[[int], bytes],
    ) -> None:
        """
        Store folder and name of the bag, and the kind of run.

        The topics of the bag follow from both the kind and the `run_info` of the nodes.
        `acknowledge` publishes the acknowledgement of a stamp in ns, and returns its bytes.
        """
        self._path = path
        self._run = run
        self._tick_topics: list[str] = []
        self._settings = settings
        self._nodes = nodes
        self._acknowledge = acknowledge
        self._bag: BagWriter | None = None
        self._normalisers: dict[str, CdrNormaliser] = {}
        self._unwritten: list[tuple[int, Tick]] = []
        self._unordered: list[tuple[str, int, bytes]] = []
        self._first_tick_at = 0.0
        self.steps = 0
        """Step of the last written tick."""
        self.wall_time_s = 0.0
        """Wall time from the first written tick to the last, s."""

    @property
    def is_open(self) -> bool:
        """Whether the bag has been created."""
        return self._bag is not None

    def write_ticks(self, ticks: Sequence[tuple[int, Tick]]) -> None:
        """Write complete ticks, given with their steps; keep them until the bag can be opened."""
        self._unwritten += ticks
        if not self._unwritten:
            return
        bag = self._bag or self._open()
        if bag is None:
            return
        for step, tick in self._unwritten:
            self._write_tick(bag, stamp_of_step(step), tick)
            self.steps = step
        self.wall_time_s = time.monotonic() - self._first_tick_at
        self._unwritten = []

    def write_unordered(self, topic: Topic, cdr: bytes) -> None:
        """Write a serialised message that belongs to no tick, if the bag has its topic."""
        if topic not in recorded_topics(self._run):
            return
        if self._bag is None:
            self._unordered.append((topic.name, stamp_of_cdr(cdr), cdr))
        else:
            self._write(self._bag, topic.name, stamp_of_cdr(cdr), cdr)

    def close(self) -> None:
        """Finish the bag; raise DdctError when that fails."""
        if self._bag is not None:
            self._bag.close()

    def _write_tick(self, bag: BagWriter, stamp: int, tick: Tick) -> None:
        # The tick is in memory now: the graph continues while it is being written.
        tick[RECORDER_ACK.name] = self._acknowledge(stamp)
        for topic in self._tick_topics:
            if topic in tick:
                self._write(bag, topic, stamp, tick[topic])

    def _write(self, bag: BagWriter, topic: str, stamp: int, cdr: bytes) -> None:
        """Write a message reproducibly; raise DdctError for one of another type."""
        try:
            data = self._normalisers[topic].normalise(cdr)
        except DdctError as error:
            raise DdctError(f'{topic} at stamp {stamp} ns: {error}', key=topic) from error
        bag.write(topic, stamp, data)

    def _open(self) -> BagWriter | None:
        """Create the bag with every `run_info`; None while one is missing."""
        if self._nodes.missing():
            return None
        facts = custom_data(self._settings, self._nodes.controller, self._nodes.steps)
        topics = recorded_topics(replace(self._run, torque_parts=bool(self._nodes.torque_parts)))
        self._tick_topics = [topic.name for topic in topics if topic.every_tick]
        self._normalisers = {
            topic.name: CdrNormaliser(load_definition(topic.type)) for topic in topics
        }
        bag = self._bag = BagWriter(*self._path, topics, facts)
        for node, pairs in self._nodes.received().items():
            # A new message: a third party's node may stamp its own with wall-clock time.
            message = RUN_INFO.message(START_NS, pairs.items(), name=node)
            self._write(bag, run_info_topic(node).name, START_NS, serialize_message(message))
        for topic, stamp, cdr in self._unordered:
            self._write(bag, topic, stamp, cdr)
        self._first_tick_at = time.monotonic()
        return bag
