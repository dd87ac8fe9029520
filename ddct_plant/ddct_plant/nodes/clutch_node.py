"""Node `clutch`: what the actuator's torque becomes between the plates at every tick."""

from typing import Any

from ddct_plant.graph.follower import FollowerNode, Reply
from ddct_plant.graph.node import Output
from ddct_plant.graph.spin import run_node
from ddct_plant.graph.topics import ACTUATOR_TORQUE, CLUTCH_TORQUE
from ddct_plant.models.clutch import LinearClutch


class ClutchNode(FollowerNode):
    """Answer `actuator/torque` with `clutch/torque`."""

    def __init__(self, **kwargs: Any) -> None:
        """Build the clutch with the run's wear gain."""
        super().__init__('clutch', **kwargs)
        self._clutch = LinearClutch(self.settings.wear_gain)
        self._torque = Output(self, CLUTCH_TORQUE)
        self.publish_run_info()
        self.follow(ACTUATOR_TORQUE)

    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Return the transmitted torque over the period of step k."""
        transmitted = self._clutch.transmit(inputs[ACTUATOR_TORQUE.name])
        return (self._torque.fill(stamp_ns, transmitted),)


def main() -> int:
    """Run the node until it is stopped."""
    return run_node('clutch', ClutchNode)


if __name__ == '__main__':
    raise SystemExit(main())
