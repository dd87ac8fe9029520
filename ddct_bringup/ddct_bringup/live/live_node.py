# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Node `live`: forwards the topics of the graph to Foxglove and takes no part in the loop."""

from collections.abc import Callable
from functools import partial
from typing import Any

from rclpy.serialization import deserialize_message, serialize_message

from ddct_bringup.bag.run_info import run_info_order
from ddct_bringup.live.server import LiveServer
from ddct_bringup.processes.live_process import ALL_TOPICS_RECEIVED, VIEWER_SUBSCRIBED
from ddct_plant.bag_file.cdr import stamp_of_cdr
from ddct_plant.base.timebase import START_NS
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.node_names import StatusName, name_in_graph
from ddct_plant.graph.qos import LIVE_QOS
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import (
    CLOCK,
    DIAGNOSTICS,
    OFF_GOING_RUN_INFO,
    RECORDER_ACK,
    RUN_INFO,
    TOPICS,
    recorded_topics,
)

_BEAT_S = 0.01
"""Period of the simulated time sent to viewers, s; in lock-step a tick takes far less."""
_PATIENCE_S = 5.0
"""Wall time without a graph before a message reports that there is none, s."""


class LiveNode(GraphNode):
    """
    Subscribe to every topic of the graph and serve it; no node waits for this one.

    Late viewers get the latched messages. When the clock goes back, as at the start of the
    next run in the same domain, viewers start afresh.
    """

    def __init__(
        self,
        host: str,
        port: int,
        print_line: Callable[[str], None] = print,
        **kwargs: Any,
    ) -> None:
        """Serve on a port of `host`; `print_line` is for the user. Raise DdctError."""
        super().__init__('live', **kwargs)
        self._print = print_line
        self._stamp_ns = self._sent_ns = START_NS
        self._run_info: dict[str, tuple[Topic, bytes]] = {}
        topics = recorded_topics(self.known.kind())
        tick_topics = {topic for topic in topics if topic.every_tick}
        self._not_received = tick_topics - {RECORDER_ACK}
        # Number of views, counted in a thread of the server; those that got time and run_info.
        self._views = self._views_timed = self._views_latched = 0
        self._server = LiveServer(host, port, self._on_view)
        self._domain = self.context.get_domain_id()
        print_line(f'serving the graph of ROS domain {self._domain} at {self._server.url}')
        self._subscribe(latched=True)
        self.every(_BEAT_S, self._beat)
        self._search = self.every(_PATIENCE_S, self._check_for_graph)

    def close(self) -> None:
        """Stop serving."""
        self._server.stop()

    def _subscribe(self, *, latched: bool) -> None:
        special: dict[Topic, Callable[[bytes], None]] = {
            CLOCK: self._on_clock,
            DIAGNOSTICS: self._on_diagnostics,
        }
        for topic in (RUN_INFO, OFF_GOING_RUN_INFO):
            special[topic] = partial(self._on_run_info, topic)
        for topic in TOPICS:
            if topic.latched == latched:
                receive = special.get(topic, partial(self._pass_on, topic))
                self.subscribe_messages(topic, receive, LIVE_QOS, raw=True)

    def _pass_on(self, topic: Topic, cdr: bytes) -> None:
        self._server.send(topic.name, stamp_of_cdr(cdr), cdr)
        if topic in self._not_received:
            self._not_received.remove(topic)
            if not self._not_received:
                self._print(ALL_TOPICS_RECEIVED)

    def _on_clock(self, cdr: bytes) -> None:
        stamp = stamp_of_cdr(cdr)
        if stamp < self._stamp_ns:
            self._send_time(stamp)
            self._views_latched = -1
        self._stamp_ns = stamp
        self._pass_on(CLOCK, cdr)

    def _on_diagnostics(self, cdr: bytes) -> None:
        """Pass on what nodes of this graph report: other graphs may share the topic."""
        message = deserialize_message(cdr, DIAGNOSTICS.message_class)
        names = [StatusName.of(status.name, self.get_namespace()) for status in message.status]
        if any(name.node for name in names):
            for status, name in zip(message.status, names, strict=True):
                status.name = str(name)
            self._pass_on(DIAGNOSTICS, serialize_message(message))

    def _on_run_info(self, topic: Topic, cdr: bytes) -> None:
        node, _ = topic.read(deserialize_message(cdr, topic.message_class))
        self._run_info[name_in_graph(node, self.get_namespace())] = topic, cdr
        self._views_latched = -1

    def _on_view(self, topic: str) -> None:
        if self._views == 0:
            self._print(f'{VIEWER_SUBSCRIBED} {topic}')
        self._views += 1

    def _beat(self) -> None:
        """Send the time; a new viewer gets the latched messages one beat after the time."""
        views = self._views
        came = views != self._views_timed
        if came and not self._views_timed:
            # Without a viewer the graph need not send anything here.
            self._subscribe(latched=False)
        if came or self._stamp_ns != self._sent_ns:
            self._send_time(self._stamp_ns)
            self._views_timed = views
        if not came and views != self._views_latched:
            for node in run_info_order(self._run_info):
                self._pass_on(*self._run_info[node])
            self._views_latched = views

    def _send_time(self, stamp_ns: int) -> None:
        self._server.set_time(stamp_ns)
        self._sent_ns = stamp_ns

    def _check_for_graph(self) -> None:
        self._search.cancel()
        clock = self.resolve_topic_name(CLOCK.name)
        if not self.count_publishers(clock):
            self._print(
                f'no graph with {clock} in ROS domain {self._domain} so far: '
                'start one with the same ROS_DOMAIN_ID and names'
            )
