"""Node `live`: passes what the graph publishes on to Foxglove and takes no part in the loop."""

from collections.abc import Callable
from functools import partial
from typing import Any

from rclpy.serialization import deserialize_message

from ddct_bringup.bag.file.cdr import stamp_of_cdr
from ddct_bringup.bag.run_facts import run_info_order
from ddct_bringup.live.server import LiveServer
from ddct_bringup.processes.live_process import HEARS_ALL, VIEWER_CAME
from ddct_plant.base.timebase import START_NS
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.qos import LIVE_QOS
from ddct_plant.graph.topics import (
    CLOCK,
    RECORDER_ACK,
    RUN_INFO,
    RunKind,
    Topic,
    all_topics,
    recorded_topics,
)

_BEAT_S = 0.01
"""How often viewers are told the time; in lock-step a tick takes far less."""
_PATIENCE_S = 5.0
"""How long to look for a graph before saying that there is none."""


class LiveNode(GraphNode):
    """
    Listen to every topic of the graph and serve it; nothing in the graph waits for this node.

    Late viewers get what is latched. A clock that goes back, as when the next run begins in the
    same domain, makes the viewers start afresh.
    """

    def __init__(
        self, host: str, port: int, say: Callable[[str], None] = print, **kwargs: Any
    ) -> None:
        """Serve on `host` and `port`; `say` takes what a user should know. Raise DdctError."""
        super().__init__('live', **kwargs)
        self._say = say
        self._stamp_ns = self._told_ns = START_NS
        self._run_info: dict[str, bytes] = {}
        run = RunKind(clutch=self.settings.clutch, sensed=self.settings.sensed)
        tick_topics = {topic for topic in recorded_topics(run) if topic.every_tick}
        self._unheard = tick_topics - {RECORDER_ACK}
        # Counted in a thread of the server's; what each beat has already done is beside it.
        self._views = self._views_timed = self._views_greeted = 0
        self._server = LiveServer(host, port, self._on_view)
        self._domain = self.context.get_domain_id()
        say(f'serving the graph of ROS domain {self._domain} at {self._server.url}')
        self._subscribe(latched=True)
        self.every(_BEAT_S, self._beat)
        self._search = self.every(_PATIENCE_S, self._look_for_graph)

    def close(self) -> None:
        """Stop serving."""
        self._server.stop()

    def _subscribe(self, *, latched: bool) -> None:
        special = {CLOCK: self._on_clock, RUN_INFO: self._on_run_info}
        for topic in all_topics():
            if topic.latched == latched:
                receive = special.get(topic, partial(self._pass_on, topic))
                self.subscribe_messages(topic, receive, LIVE_QOS, raw=True)

    def _pass_on(self, topic: Topic, cdr: bytes) -> None:
        self._server.send(topic.name, stamp_of_cdr(cdr), cdr)
        if topic in self._unheard:
            self._unheard.remove(topic)
            if not self._unheard:
                self._say(HEARS_ALL)

    def _on_clock(self, cdr: bytes) -> None:
        stamp = stamp_of_cdr(cdr)
        if stamp < self._stamp_ns:
            self._tell_time(stamp)
            self._views_greeted = -1
        self._stamp_ns = stamp
        self._pass_on(CLOCK, cdr)

    def _on_run_info(self, cdr: bytes) -> None:
        node, _ = RUN_INFO.read(deserialize_message(cdr, RUN_INFO.message_class))
        self._run_info[node] = cdr
        self._views_greeted = -1

    def _on_view(self, topic: str) -> None:
        if self._views == 0:
            self._say(f'{VIEWER_CAME} {topic}')
        self._views += 1

    def _beat(self) -> None:
        """Tell the time; a new viewer gets first that, and one beat later what is latched."""
        views = self._views
        came = views != self._views_timed
        if came and not self._views_timed:
            # Until somebody looks, a graph need not send anything here.
            self._subscribe(latched=False)
        if came or self._stamp_ns != self._told_ns:
            self._tell_time(self._stamp_ns)
            self._views_timed = views
        if not came and views != self._views_greeted:
            for node in run_info_order(self._run_info):
                self._pass_on(RUN_INFO, self._run_info[node])
            self._views_greeted = views

    def _tell_time(self, stamp_ns: int) -> None:
        self._server.set_time(stamp_ns)
        self._told_ns = stamp_ns

    def _look_for_graph(self) -> None:
        self._search.cancel()
        if not self.count_publishers(CLOCK.name):
            self._say(
                f'no graph in ROS domain {self._domain} so far: '
                'start one with the same ROS_DOMAIN_ID'
            )
