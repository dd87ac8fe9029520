"""Node `load`: the road's resistance at the wheel at every tick."""

from typing import Any

from geometry_msgs.msg import TwistStamped, WrenchStamped

from ddct_plant.graph.arrivals import read_vehicle_speed
from ddct_plant.graph.follower import FollowerNode, Reply
from ddct_plant.graph.messages import torque_message
from ddct_plant.graph.qos import LOOP_QOS
from ddct_plant.graph.spin import run_node
from ddct_plant.models.load import RoadLoad


class LoadNode(FollowerNode):
    """Answer `vehicle/twist` with `load/torque`."""

    def __init__(self, **kwargs: Any) -> None:
        """Build the load of the run's scenario."""
        super().__init__('load', **kwargs)
        self._load = RoadLoad(self.settings.scenario.load, self.settings.scenario.vehicle)
        self._torque = self.create_publisher(WrenchStamped, 'load/torque', LOOP_QOS)
        self._message = WrenchStamped()
        self.publish_run_info()
        self.follow([(TwistStamped, 'vehicle/twist', read_vehicle_speed)])

    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Return C_load at the vehicle speed of t_k."""
        torque = self._load.torque(inputs['vehicle/twist'])
        return ((self._torque, torque_message(stamp_ns, torque, reuse=self._message)),)


def main() -> int:
    """Run the node until it is stopped."""
    return run_node('load', LoadNode)


if __name__ == '__main__':
    raise SystemExit(main())
