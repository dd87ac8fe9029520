# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Node `load`: the road's resistance at the wheel at every tick."""

from typing import Any

from ddct_plant.base.timebase import time_of_step
from ddct_plant.graph.follower import FollowerNode, Reply
from ddct_plant.graph.output import Output
from ddct_plant.graph.spin import run_node
from ddct_plant.scenario.plant import holding_torque, make_load
from ddct_plant.signals.topics import HOLDING_TORQUE, LOAD_TORQUE, VEHICLE_SPEED


class LoadNode(FollowerNode):
    """Answer `vehicle/twist` with `load/torque`, and `load/holding_torque` in stick-slip runs."""

    def __init__(self, **kwargs: Any) -> None:
        """Build the load of the run's scenario."""
        super().__init__('load', **kwargs)
        self._load = make_load(self.settings)
        self._torque = Output(self, LOAD_TORQUE)
        if self.known.stick_slip:
            self._friction = holding_torque(self.settings)
            self._holding = Output(self, HOLDING_TORQUE)
        self.publish_run_info()
        self.follow(VEHICLE_SPEED)

    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Return C_load at the vehicle speed of t_k, and the holding torque at the wheels."""
        time_s = time_of_step(step)
        load = self._load.torque(inputs[VEHICLE_SPEED.name], time_s)
        torque = self._torque.fill(stamp_ns, load)
        if not self.known.stick_slip:
            return (torque,)
        capacity = self._friction.capacity(time_s)
        return (torque, self._holding.fill(stamp_ns, capacity))


def main() -> int:
    """Run the node until it is stopped."""
    return run_node('load', LoadNode)


if __name__ == '__main__':
    raise SystemExit(main())
