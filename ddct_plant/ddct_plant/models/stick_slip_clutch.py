"""The clutch of a stick-slip run: what it can carry, and how warm it is."""

from collections.abc import Sequence
from typing import NamedTuple

from ddct_plant.models.clutch_heat import ClutchHeat
from ddct_plant.models.friction_clutch import FrictionClutch


class ClutchReply(NamedTuple):
    """What the clutch answers a tick with."""

    kinetic: list[float]
    """(11,) capacity while it slips, in N m at 0, 1, ..., 10 ms, >= 0."""
    static: list[float]
    """(11,) the same while it sticks, at least the kinetic one."""
    temperature_c: float
    """Of the facing at t_k in degrees Celsius; the capacities are those at this temperature."""


class StickSlipClutch:
    """
    Capacities over each period, at the temperature and slip speed at its start.

    The friction work of the periods that have ended warms it before.
    """

    def __init__(self, friction: FrictionClutch, heat: ClutchHeat) -> None:
        """Start at t_0, at the temperatures of `heat`."""
        self._friction = friction
        self._heat = heat
        self._step = 0

    def reply(
        self,
        step: int,
        actuator_torque: Sequence[float],
        slip_speed: float,
        friction_work: float,
    ) -> ClutchReply:
        """
        Return the reply to t_k for the (11,) actuator torques in N m, w_d in rad/s at t_k.

        `friction_work` in J is that of the last period; periods before it that were not heard of,
        as may be in real time, count with the same work. Steps rise from call to call.
        """
        for _ in range(self._step, step):
            self._heat.advance(friction_work)
        self._step = step
        temperature_c = self._heat.facing_c
        capacity = self._friction.capacity(actuator_torque, temperature_c, slip_speed)
        return ClutchReply(capacity.kinetic, capacity.static, temperature_c)
