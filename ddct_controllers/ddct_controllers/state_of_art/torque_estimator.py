"""Control of both speeds with an estimate of the clutch torque, after [2] (Section 1.3)."""

import math

from ddct_controllers.interface import (
    Command,
    Controller,
    ControllerContext,
    ControllerSpec,
    Measurement,
)
from ddct_controllers.measured import measured_speeds
from ddct_controllers.state_of_art.parts.engine_share import EngineShare
from ddct_controllers.state_of_art.parts.pid import placed_gains
from ddct_controllers.state_of_art.parts.slow_clutch import SlowClutch
from ddct_plant.base.options import Option
from ddct_plant.base.timebase import PERIOD_S

OPTIONS = {
    'shaft_bandwidth_rad_s': Option(
        0.5, 'bandwidth of the loop of the shaft speed', 'rad/s', at_least=0.1, at_most=1.0
    ),
    'engine_bandwidth_rad_s': Option(
        10.0, 'bandwidth of the loop of the engine speed', 'rad/s', at_least=5.0, at_most=20.0
    ),
    'estimator_bandwidth_rad_s': Option(
        30.0,
        'bandwidth of the estimator of the clutch torque',
        'rad/s',
        at_least=10.0,
        at_most=60.0,
    ),
}
"""Tested to be stable at wear gains from 0.7 to 1.3: docs/controllers/state_of_art.md says why."""


class ClutchTorqueEstimator:
    """
    A Luenberger observer of J_m dw_m/dt = C_m - C_n - d, with d constant.

    C_n is the clutch torque that the actuator's model gives, d what the clutch transmits beyond
    it, which wear or another fault makes. Both poles of the sampled observer are at
    exp(-bandwidth T). Damping of the engine counts as part of d.
    """

    def __init__(self, engine_inertia: float, bandwidth_rad_s: float) -> None:
        """Take J_m in kg m^2 and the bandwidth."""
        pole = math.exp(-bandwidth_rad_s * PERIOD_S)
        self._speed_gain = 1.0 - pole**2
        self._torque_gain = -engine_inertia * (1.0 - pole) ** 2 / PERIOD_S
        self._engine_inertia = engine_inertia
        self.reset()

    def reset(self) -> None:
        """Forget everything; the next speed starts an estimate with d = 0."""
        self._speed: float | None = None
        self._deviation = 0.0

    def correct(self, engine_speed: float) -> float:
        """Return d in N m for w_m in rad/s."""
        if self._speed is None:
            self._speed = engine_speed
        innovation = engine_speed - self._speed
        self._speed += self._speed_gain * innovation
        self._deviation += self._torque_gain * innovation
        return self._deviation

    def predict(self, engine_torque: float, nominal_clutch_torque: float) -> None:
        """Advance by one period over which C_m and C_n have these means in N m."""
        assert self._speed is not None, 'correct comes first'
        torque = engine_torque - nominal_clutch_torque - self._deviation
        self._speed += PERIOD_S * torque / self._engine_inertia


class TorqueEstimatorControl(Controller):
    """
    Clutch and engine speed follow references, each with a torque of its own.

    The shaft follows w_p* = w_m* - w_d*: C_f = C_load/tau + J_eq (dw_p*/dt + PID(w_p* - w_p)),
    less what the clutch is estimated to transmit beyond the actuator's model, as far as
    `SlowClutch` passes it. The engine follows w_p + w_d*: its loop gives the difference
    C_m - C_f = J_m (dw_p/dt + dw_d*/dt + PID(w_p + w_d* - w_m)), which is added to the estimated
    C_f; dw_p/dt is that of the rigid transmission with this C_f. The shaft's loop waits while the
    engine is at its limit.
    """

    commands_engine = True

    def __init__(self, context: ControllerContext) -> None:
        """Tune loops and estimator by the values of OPTIONS."""
        options = context.gains
        self._clutch = SlowClutch(context, options['shaft_bandwidth_rad_s'])
        transmission = self._clutch.transmission
        authority = context.settings.scenario.engine_authority
        engine_gains = placed_gains(options['engine_bandwidth_rad_s'], authority.lag_s)
        self._engine = EngineShare(transmission, authority, engine_gains)
        self._estimator = ClutchTorqueEstimator(
            transmission.engine_inertia, options['estimator_bandwidth_rad_s']
        )

    def reset(self) -> None:
        """Forget plan and estimate, empty both integrals, put actuator and engine to rest."""
        for part in (self._clutch, self._engine, self._estimator):
            part.reset()

    def hold(self, measurement: Measurement) -> None:
        """Let the estimator follow the clutch under the open-loop torque."""
        engine_speed, _, _ = measured_speeds(measurement)
        self._estimator.correct(engine_speed)
        nominal = self._clutch.nominal(measurement.open_loop_torque)
        self._estimator.predict(self._engine.hold(measurement), nominal)

    def update(self, measurement: Measurement) -> Command:
        """Return both torques of the coming period."""
        engine_speed, shaft_speed, _ = measured_speeds(measurement)
        deviation = self._estimator.correct(engine_speed)
        waits = self._engine.at_its_limit
        planned_speed, planned_rate = self._clutch.plan.update(measurement, afresh=waits)
        slip, slip_rate = measurement.slip_reference[0], measurement.slip_reference_rate[0]
        shaft_rate = planned_rate - slip_rate
        if not waits:
            shaft_rate += self._clutch.pid.update(planned_speed - slip - shaft_speed)
        shaft_rate -= deviation / self._clutch.transmission.vehicle_inertia
        request = self._clutch.request(measurement, shaft_rate, self._engine.clutch_torque)
        nominal = self._clutch.nominal(request)
        estimate = nominal + deviation
        engine_request, delivered = self._engine.update(
            measurement, estimate, shaft_speed + slip - engine_speed, slip_rate
        )
        self._estimator.predict(delivered, nominal)
        return Command(
            request - measurement.open_loop_torque,
            (
                ('engine_speed_reference_rad_s', repr(planned_speed)),
                ('clutch_torque_estimate_n_m', repr(estimate)),
                ('engine_at_its_limit', str(self._engine.at_its_limit).lower()),
            ),
            engine_request,
        )


SPEC = ControllerSpec('torque_estimator', TorqueEstimatorControl, OPTIONS)
