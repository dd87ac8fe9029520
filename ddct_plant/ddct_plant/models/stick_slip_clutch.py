"""The clutch of a stick-slip run: what it can carry, and how warm it is."""

from collections.abc import Sequence

from ddct_plant.models.clutch_heat import ClutchHeat
from ddct_plant.models.friction_clutch import Capacity, FrictionClutch


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
    ) -> Capacity:
        """
        Return the reply to t_k for the (11,) actuator torques in N m, w_d in rad/s at t_k.

        `friction_work` in J is that of the last period; periods before it that were not heard of,
        as may be in real time, count with the same work. Steps rise from call to call.
        """
        for _ in range(self._step, step):
            self._heat.advance(friction_work)
        self._step = step
        return self._friction.capacity(actuator_torque, self._heat.facing_c, slip_speed)
