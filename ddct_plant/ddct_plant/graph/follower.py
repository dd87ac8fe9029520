"""Base of the nodes that answer ticks: engine, load, clutch, actuator, reference, controller."""

from abc import abstractmethod
from collections.abc import Sequence
from typing import Any

from rclpy.publisher import Publisher

from ddct_plant.errors import DdctError
from ddct_plant.graph.join import StampJoin, Verdict
from ddct_plant.graph.messages import stamp_ns
from ddct_plant.graph.node import GraphNode
from ddct_plant.graph.qos import LOOP_QOS

Reply = Sequence[tuple[Publisher, Any]]
"""Messages in the order in which they are published."""


class FollowerNode(GraphNode):
    """
    Pure data flow: join inputs by stamp, answer once per stamp, repeat the answer when asked.

    A subclass gives its inputs to `follow` and computes the reply in `answer`. Nothing here reads
    a clock, so the trajectory does not depend on when messages arrive.
    """

    def follow(self, inputs: Sequence[tuple[type, str]]) -> None:
        """Subscribe to (type, topic) inputs; the first is the trigger of `StampJoin`."""
        self.join = StampJoin(
            [topic for _, topic in inputs], allow_gaps=not self.settings.lockstep
        )
        self._reply: Reply = ()
        for message_type, topic in inputs:
            self.create_subscription(message_type, topic, self._callback(topic), LOOP_QOS)

    @abstractmethod
    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Compute the reply to the inputs of one stamp; called once per stamp, in order."""

    def _callback(self, topic: str) -> Any:
        offer, complete, repeat = self.join.offer, Verdict.COMPLETE, Verdict.REPEAT

        def receive(message: Any) -> None:
            stamp = stamp_ns(message)
            verdict = offer(topic, stamp, message)
            if verdict is complete:
                self._answer(stamp)
                self.publish_reply()
            elif verdict is repeat:
                self.publish_reply()

        return self.guarded(receive)

    def _answer(self, stamp: int) -> None:
        step, inputs = self.join.take()
        try:
            self._reply = self.answer(step, stamp, inputs)
        except DdctError as error:
            raise DdctError(f'at stamp {stamp} ns: {error}') from error

    def publish_reply(self) -> None:
        """Publish the reply to the last stamp, again if it was published before."""
        for publisher, message in self._reply:
            publisher.publish(message)
