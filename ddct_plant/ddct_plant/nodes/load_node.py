"""Node `load`: the road's resistance at the wheel at every tick."""

from typing import Any

from ddct_plant.graph.follower import FollowerNode, Reply
from ddct_plant.graph.node import Output
from ddct_plant.graph.spin import run_node
from ddct_plant.graph.topics import LOAD_TORQUE, VEHICLE_SPEED
from ddct_plant.models.load import RoadLoad


class LoadNode(FollowerNode):
    """Answer `vehicle/twist` with `load/torque`."""

    def __init__(self, **kwargs: Any) -> None:
        """Build the load of the run's scenario."""
        super().__init__('load', **kwargs)
        self._load = RoadLoad(self.settings.scenario.load, self.settings.scenario.vehicle)
        self._torque = Output(self, LOAD_TORQUE)
        self.publish_run_info()
        self.follow(VEHICLE_SPEED)

    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Return C_load at the vehicle speed of t_k."""
        return (self._torque.fill(stamp_ns, self._load.torque(inputs[VEHICLE_SPEED.name])),)


def main() -> int:
    """Run the node until it is stopped."""
    return run_node('load', LoadNode)


if __name__ == '__main__':
    raise SystemExit(main())
