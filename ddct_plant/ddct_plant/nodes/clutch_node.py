"""Node `clutch`: what the actuator's torque becomes between the plates at every tick."""

from typing import Any

from trajectory_msgs.msg import JointTrajectory

from ddct_plant.graph.arrivals import read_torque_points
from ddct_plant.graph.follower import FollowerNode, Reply
from ddct_plant.graph.messages import TorquePointsMessage
from ddct_plant.graph.qos import LOOP_QOS
from ddct_plant.graph.spin import run_node
from ddct_plant.models.clutch import LinearClutch


class ClutchNode(FollowerNode):
    """Answer `actuator/torque` with `clutch/torque`."""

    def __init__(self, **kwargs: Any) -> None:
        """Build the clutch with the run's wear gain."""
        super().__init__('clutch', **kwargs)
        self._clutch = LinearClutch(self.settings.wear_gain)
        self._torque = self.create_publisher(JointTrajectory, 'clutch/torque', LOOP_QOS)
        self._message = TorquePointsMessage()
        self.publish_run_info()
        self.follow([(JointTrajectory, 'actuator/torque', read_torque_points)])

    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Return the transmitted torque over the period of step k."""
        transmitted = self._clutch.transmit(inputs['actuator/torque'])
        return ((self._torque, self._message.fill(stamp_ns, transmitted)),)


def main() -> int:
    """Run the node until it is stopped."""
    return run_node('clutch', ClutchNode)


if __name__ == '__main__':
    raise SystemExit(main())
