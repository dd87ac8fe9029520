# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Node `clutch`: computes the torque between the plates from the actuator's, at every tick."""

from typing import Any

from ddct_plant.graph.follower import FollowerNode, Reply
from ddct_plant.graph.node_reports import role_info
from ddct_plant.graph.output import Output
from ddct_plant.graph.settings import declare_role
from ddct_plant.graph.spin import run_node
from ddct_plant.scenario.plant import friction_clutch, linear_clutch
from ddct_plant.signals.topics import (
    ACTUATOR_TORQUE,
    CLUTCH_PHASE,
    CLUTCH_TEMPERATURE,
    CLUTCH_TORQUE,
    SLIP,
)


class ClutchNode(FollowerNode):
    """
    Answer `actuator/torque` with `clutch/torque`, the transmitted torque of the linear clutch.

    In a stick-slip run `clutch/torque` has the kinetic and the static capacity, which depend on
    `clutch/slip` and on the friction work of `clutch/phase` too, and `clutch/temperature` is
    published beside it. In a gear shift a second one, in a namespace of its own, has the `role`
    off_going, and with it `off_going_wear_gain`.
    """

    def __init__(self, **kwargs: Any) -> None:
        """Build the clutch of the run, with its wear gain."""
        super().__init__('clutch', **kwargs)
        role = declare_role(self, self.known)
        self._torque = Output(self, CLUTCH_TORQUE)
        self.publish_run_info(role_info(self.known, role))
        if self.known.stick_slip:
            self._friction = friction_clutch(self.settings, role)
            self._temperature = Output(self, CLUTCH_TEMPERATURE)
            self.follow(ACTUATOR_TORQUE, SLIP, CLUTCH_PHASE)
        else:
            self._linear = linear_clutch(self.settings)
            self.follow(ACTUATOR_TORQUE)

    def answer(self, step: int, stamp_ns: int, inputs: dict[str, Any]) -> Reply:
        """Return the transmitted torque, or the capacities, over the period of step k."""
        (actuator_torque,) = inputs[ACTUATOR_TORQUE.name]
        if not self.known.stick_slip:
            return (self._torque.fill(stamp_ns, self._linear.transmit(actuator_torque)),)
        reply = self._friction.reply(
            step, actuator_torque, inputs[SLIP.name], inputs[CLUTCH_PHASE.name]
        )
        return (
            self._torque.fill(stamp_ns, reply.kinetic, reply.static),
            self._temperature.fill(stamp_ns, reply.temperature_c),
        )


def main() -> int:
    """Run the node until it is stopped."""
    return run_node('clutch', ClutchNode)


if __name__ == '__main__':
    raise SystemExit(main())
