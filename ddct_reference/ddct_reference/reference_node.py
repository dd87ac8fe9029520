"""Node `reference`: the slip speed that the controller shall follow, with its preview."""

from typing import Any, ClassVar

from geometry_msgs.msg import TwistStamped
from trajectory_msgs.msg import JointTrajectory

from ddct_plant.graph.arrivals import read_slip
from ddct_plant.graph.follower import FollowerNode, Reply
from ddct_plant.graph.messages import SlipReferenceMessage
from ddct_plant.graph.qos import LOOP_QOS
from ddct_plant.graph.settings import declare
from ddct_plant.graph.spin import run_node
from ddct_reference.factory import make_reference


class ReferenceNode(FollowerNode):
    """Answer `clutch/slip` with `clutch/slip_reference`, `preview_steps` periods ahead."""

    EXAMPLES: ClassVar[tuple[str, ...]] = ('-p preview_steps:=22',)

    def __init__(self, **kwargs: Any) -> None:
        """Build the reference of the run's scenario and architecture."""
        super().__init__('reference', **kwargs)
        preview_steps = declare(
            self, 'preview_steps', 0, 'Periods to look ahead, as the controller needs', 0, 1000
        )
        self._reference = make_reference(self.settings, preview_steps)
        self._publisher = self.create_publisher(JointTrajectory, 'clutch/slip_reference', LOOP_QOS)
        self._message = SlipReferenceMessage(preview_steps)
        self.publish_run_info({'preview_steps': str(preview_steps)})
        self.follow([(TwistStamped, 'clutch/slip', read_slip)])

    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Return the reference at t_k and ahead."""
        speeds, rates = self._reference.update(step, inputs['clutch/slip'])
        return ((self._publisher, self._message.fill(stamp_ns, speeds, rates)),)


def main() -> int:
    """Run the node until it is stopped."""
    return run_node('reference', ReferenceNode)


if __name__ == '__main__':
    raise SystemExit(main())
