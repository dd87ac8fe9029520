# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Node `reference`: the slip reference for the controller, with its preview."""

import math
from typing import Any, ClassVar

from ddct_plant.base.options import Option
from ddct_plant.graph.follower import FollowerNode, Reply
from ddct_plant.graph.node_reports import reference_info
from ddct_plant.graph.output import Output
from ddct_plant.graph.settings import declare
from ddct_plant.graph.spin import run_node
from ddct_plant.shift.balance import WHOLE
from ddct_plant.signals.topics import HANDOVER_SHARE, SLIP_REFERENCE, measurement_topics
from ddct_reference.factory import make_reference


class ReferenceNode(FollowerNode):
    """
    Answer `clutch/slip` with `clutch/slip_reference`, `preview_steps` periods ahead.

    With the shape `engine_speed_target` it also subscribes to `driveline/joint_states`. In a run
    with sensors it subscribes to their topics for both. In a gear shift it waits for
    `clutch/handover_share` too, and starts with the first period whose share is 1.
    """

    KNOWN_ONLY: ClassVar[bool] = True
    EXAMPLES: ClassVar[tuple[str, ...]] = ('-p preview_steps:=22',)

    def __init__(self, **kwargs: Any) -> None:
        """Build the reference of the run's scenario and architecture."""
        super().__init__('reference', **kwargs)
        preview_steps = declare(
            self,
            'preview_steps',
            Option(0, 'periods to look ahead, as the controller needs', at_least=0, at_most=1000),
        )
        self._reference = make_reference(self.known, preview_steps)
        self._output = Output(self, SLIP_REFERENCE)
        self.publish_run_info(reference_info(preview_steps))
        self._measured_topics = measurement_topics(sensed=self.known.sensed)
        shafts = (self._measured_topics.joint_states,) if self._reference.follows_shaft else ()
        shares = (HANDOVER_SHARE,) if self.known.shift else ()
        self.follow(self._measured_topics.slip, *shafts, *shares)

    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Return the reference at t_k and ahead."""
        shaft_speed = math.nan
        if self._reference.follows_shaft:
            shaft_speed = inputs[self._measured_topics.joint_states.name].primary_shaft
        speeds, rates = self._reference.update(
            step,
            inputs[self._measured_topics.slip.name],
            shaft_speed,
            inputs.get(HANDOVER_SHARE.name, WHOLE).share,
        )
        return (self._output.fill(stamp_ns, speeds, rates),)


def main() -> int:
    """Run the node until it is stopped."""
    return run_node('reference', ReferenceNode)


if __name__ == '__main__':
    raise SystemExit(main())
