"""Which engine speed two-input controllers follow: the scenario's, or what the demand implies."""

from ddct_controllers.interface import Measurement
from ddct_controllers.state_of_art.parts.rigid_transmission import RigidTransmission
from ddct_plant.base.timebase import PERIOD_S, time_of_step
from ddct_plant.scenario.references import EngineSpeedReference


class SpeedPlan:
    """
    The engine speed reference w_m* and its rate, step by step.

    Without points in the scenario, w_m* = (H + J_eq s)/(J_m + J_eq), s the slip reference: the
    speed at which the transmission has the slip asked for and the momentum H that the driver's
    demand and the load give it, dH/dt = C_m - C_load/tau. Followed exactly, it needs no other
    engine torque than the demand. H starts as measured when control starts.
    """

    def __init__(self, transmission: RigidTransmission, given: EngineSpeedReference) -> None:
        """Plan for a transmission; `given` prevails if it has points."""
        self._transmission = transmission
        self._given = given
        self.reset()

    def reset(self) -> None:
        """Forget the momentum; the next update measures it."""
        self._momentum: float | None = None

    def update(self, measurement: Measurement, *, afresh: bool = False) -> tuple[float, float]:
        """
        Return w_m* in rad/s and its rate over the coming period in rad/s^2.

        `afresh` measures the momentum anew.
        """
        if self._given.given:
            now, then = (
                self._given.at(time_of_step(step))
                for step in (measurement.step, measurement.step + 1)
            )
            return now, (then - now) / PERIOD_S
        transmission = self._transmission
        momentum = self._momentum
        if momentum is None or afresh:
            momentum = transmission.momentum(measurement)
        vehicle = transmission.vehicle_inertia
        total = transmission.engine_inertia + vehicle
        acceleration = transmission.constant_slip_acceleration(measurement)
        self._momentum = momentum + PERIOD_S * total * acceleration
        return (
            (momentum + vehicle * measurement.slip_reference[0]) / total,
            acceleration + vehicle / total * measurement.slip_reference_rate[0],
        )
