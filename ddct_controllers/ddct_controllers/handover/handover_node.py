# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Node `handover`: hands the torque of a gear shift from one clutch to the other, every tick."""

from collections.abc import Mapping
from typing import Any, ClassVar

from ddct_controllers.handover.interface import HandoverMeasurement
from ddct_controllers.handover.laws import make_handover
from ddct_plant.graph.follower import FollowerNode, Reply
from ddct_plant.graph.node_reports import handover_info
from ddct_plant.graph.output import Output
from ddct_plant.graph.spin import run_node
from ddct_plant.scenario.rules.shift import gears_of
from ddct_plant.signals.topics import (
    HANDOVER_SHARE,
    OFF_GOING_SLIP,
    OFF_GOING_TORQUE_REQUEST,
    TORQUE_CUT,
    TORQUE_DEMAND,
    measurement_topics,
)


class HandoverNode(FollowerNode):
    """
    Answer the speeds and the demand of a tick with share, off-going request and torque cut.

    Only a gear shift has this node. The parameter `handover` names its law. It joins topics of the
    tick and `engine/torque_demand` alone, so that engine, reference and controller can wait for
    its answer. In a run with sensors it reads theirs; none is at the off-going shaft, whose speed
    is then that of the on-coming one times the ratio of the gears.
    """

    KNOWN_ONLY: ClassVar[bool] = True
    DEFAULTS: ClassVar[Mapping[str, Any]] = {'scenario': 'upshift'}

    def __init__(self, **kwargs: Any) -> None:
        """Build the handover of the run; raise ParameterError for a run without a shift."""
        super().__init__('handover', **kwargs)
        self._handover = make_handover(self.known)
        self._share = Output(self, HANDOVER_SHARE)
        self._request = Output(self, OFF_GOING_TORQUE_REQUEST)
        self._cut = Output(self, TORQUE_CUT)
        self.publish_run_info(handover_info(self.known))
        self._ratio = gears_of(self.known.scenario).ratio
        self._topics = measurement_topics(sensed=self.known.sensed)
        self.follow(
            self._topics.joint_states,
            self._topics.slip,
            self._topics.vehicle_speed,
            TORQUE_DEMAND,
            *(() if self.known.sensed else (OFF_GOING_SLIP,)),
        )

    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Return the command for the period of step k; the cut has the longest way."""
        joints = inputs[self._topics.joint_states.name]
        if self.known.sensed:
            off_going_slip = joints.engine - self._ratio * joints.primary_shaft
        else:
            off_going_slip = inputs[OFF_GOING_SLIP.name]
        command = self._handover.update(
            HandoverMeasurement(
                step=step,
                demand=inputs[TORQUE_DEMAND.name],
                engine_speed=joints.engine,
                on_coming_slip=inputs[self._topics.slip.name],
                off_going_slip=off_going_slip,
                vehicle_speed=inputs[self._topics.vehicle_speed.name],
            )
        )
        return (
            self._cut.fill(stamp_ns, command.torque_cut),
            self._share.fill(stamp_ns, *command.on_coming),
            self._request.fill(stamp_ns, command.off_going_request),
        )


def main() -> int:
    """Run the node until it is stopped."""
    return run_node('handover', HandoverNode)


if __name__ == '__main__':
    raise SystemExit(main())
