"""Node `engine`: the driver's demand and the delivered engine torque at every tick."""

from typing import Any

from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState

from ddct_plant.engine import Engine
from ddct_plant.graph.follower import FollowerNode, Reply
from ddct_plant.graph.messages import torque_message
from ddct_plant.graph.qos import LOOP_QOS
from ddct_plant.graph.spin import run_node


class EngineNode(FollowerNode):
    """Answer `driveline/joint_states` with `engine/torque_demand` and `engine/torque`."""

    def __init__(self, **kwargs: Any) -> None:
        """Build the engine of the run's scenario."""
        super().__init__('engine', **kwargs)
        self._engine = Engine(self.settings.scenario.engine)
        self._demand = self.create_publisher(WrenchStamped, 'engine/torque_demand', LOOP_QOS)
        self._torque = self.create_publisher(WrenchStamped, 'engine/torque', LOOP_QOS)
        self._demand_message = WrenchStamped()
        self._torque_message = WrenchStamped()
        self.publish_run_info()
        self.follow([(JointState, 'driveline/joint_states')])

    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Return the demand at t_k and the torque over the period of step k."""
        return (
            (
                self._torque,
                torque_message(stamp_ns, self._engine.torque(step), reuse=self._torque_message),
            ),
            (
                self._demand,
                torque_message(stamp_ns, self._engine.demand(step), reuse=self._demand_message),
            ),
        )


def main() -> int:
    """Run the node until it is stopped."""
    return run_node('engine', EngineNode)


if __name__ == '__main__':
    raise SystemExit(main())
