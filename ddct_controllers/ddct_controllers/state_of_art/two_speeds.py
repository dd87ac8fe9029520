# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Control of two speeds with two torques, after [2] and [3] of the thesis (Section 1.3)."""

from ddct_controllers.interface import (
    Command,
    Controller,
    ControllerContext,
    ControllerSpec,
    Measurement,
)
from ddct_controllers.measurement import measured_speeds
from ddct_controllers.state_of_art.parts.slow_clutch import SlowClutch
from ddct_controllers.state_of_art.parts.speed_loops import ClutchTorqueEstimator, EngineShare
from ddct_plant.base.options import Option


class TwoSpeeds(Controller):
    """A slow speed that the clutch controls, and the other one, which the engine controls."""

    commands_engine = True

    def __init__(self, context: ControllerContext, slow_rad_s: float, fast_rad_s: float) -> None:
        """Tune both loops to these bandwidths."""
        self._clutch = SlowClutch(context, slow_rad_s)
        authority = context.settings.scenario.engine_authority
        lag_s = self._clutch.actuator.lag_s
        self._engine = EngineShare(self._clutch.transmission, authority, fast_rad_s, lag_s)

    def reset(self) -> None:
        """Clear the plan, empty both integrals, put actuator and engine at rest."""
        self._clutch.reset()
        self._engine.reset()


class TorqueEstimatorControl(TwoSpeeds):
    """
    Clutch and engine speed follow references, each with a torque of its own.

    The shaft follows w_p* = w_m* - w_d*: C_f = C_load/tau + J_eq (dw_p*/dt + PID(w_p* - w_p)),
    less the torque that the clutch is estimated to transmit beyond the actuator's model, as far as
    `SlowClutch` passes it. The engine follows w_p + w_d*: its loop gives the difference C_m - C_f
    = J_m (dw_p/dt + dw_d*/dt + PID(w_p + w_d* - w_m)), which is added to the estimated C_f;
    dw_p/dt is that of the rigid transmission with this C_f. The shaft's loop waits while the
    engine is at its limit.
    """

    def __init__(self, context: ControllerContext) -> None:
        """Tune loops and estimator."""
        options = context.gains
        super().__init__(
            context, options['shaft_bandwidth_rad_s'], options['engine_bandwidth_rad_s']
        )
        self._estimator = ClutchTorqueEstimator(
            self._clutch.transmission.engine_inertia, options['estimator_bandwidth_rad_s']
        )

    def reset(self) -> None:
        """Reset both loops and clear the estimate."""
        super().reset()
        self._estimator.reset()

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


class DecoupledPid(TwoSpeeds):
    """
    Two PIDs whose outputs are the accelerations of engine and slip, and a decoupler.

    a_m = dw_m*/dt + PID(w_m* - w_m) and a_d = dw_d*/dt + PID(w_d* - w_d). The clutch gives the
    shaft a_m - dw_d*/dt, as far as `SlowClutch` passes it, and the engine gives the slip a_d: C_m
    = C_f + J_m ((C_f - C_load/tau)/J_eq + a_d), with the C_f of the actuator's model for the
    period. So neither the first PID nor the lag of the clutch moves the slip. The first PID
    compensates the effect of the second on the engine speed; it waits while the engine is at its
    limit.
    """

    def __init__(self, context: ControllerContext) -> None:
        """Tune the loops."""
        options = context.gains
        super().__init__(
            context, options['engine_bandwidth_rad_s'], options['slip_bandwidth_rad_s']
        )

    def hold(self, measurement: Measurement) -> None:
        """Let the models of actuator and engine follow the open-loop torque and the demand."""
        measured_speeds(measurement)
        self._clutch.nominal(measurement.open_loop_torque)
        self._engine.hold(measurement)

    def update(self, measurement: Measurement) -> Command:
        """Return both torques of the coming period."""
        engine_speed, _, _ = measured_speeds(measurement)
        waits = self._engine.at_its_limit
        planned_speed, engine_rate = self._clutch.plan.update(measurement, afresh=waits)
        if not waits:
            engine_rate += self._clutch.pid.update(planned_speed - engine_speed)
        slip_rate = measurement.slip_reference_rate[0]
        request = self._clutch.request(
            measurement, engine_rate - slip_rate, self._engine.clutch_torque
        )
        slip_error = measurement.slip_reference[0] - measurement.slip_speed
        engine_request, _ = self._engine.update(
            measurement, self._clutch.nominal(request), slip_error, slip_rate
        )
        return Command(
            request - measurement.open_loop_torque,
            (
                ('engine_speed_reference_rad_s', repr(planned_speed)),
                ('engine_at_its_limit', str(self._engine.at_its_limit).lower()),
            ),
            engine_request,
        )


SPECS = (
    ControllerSpec(
        'torque_estimator',
        TorqueEstimatorControl,
        {
            'shaft_bandwidth_rad_s': Option(
                0.5, 'bandwidth of the loop of the shaft speed', 'rad/s', at_least=0.1, at_most=1.0
            ),
            'engine_bandwidth_rad_s': Option(
                10.0,
                'bandwidth of the loop of the engine speed',
                'rad/s',
                at_least=5.0,
                at_most=20.0,
            ),
            'estimator_bandwidth_rad_s': Option(
                30.0,
                'bandwidth of the estimator of the clutch torque',
                'rad/s',
                at_least=10.0,
                at_most=60.0,
            ),
        },
    ),
    ControllerSpec(
        'decoupled_pid',
        DecoupledPid,
        {
            'engine_bandwidth_rad_s': Option(
                0.5,
                'bandwidth of the loop of the engine speed',
                'rad/s',
                at_least=0.1,
                at_most=1.0,
            ),
            'slip_bandwidth_rad_s': Option(
                10.0, 'bandwidth of the loop of the slip', 'rad/s', at_least=5.0, at_most=20.0
            ),
        },
    ),
)
"""
Specifications of [2] and [3] of the thesis by name.

Tested to be stable at wear gains from 0.7 to 1.3: docs/controllers/least_jerk.md has the
reasons.
"""
