"""Decoupled PID control of engine speed and slip speed, after [3] of the thesis (Section 1.3)."""

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

OPTIONS = {
    'engine_bandwidth_rad_s': Option(
        0.5, 'bandwidth of the loop of the engine speed', 'rad/s', at_least=0.1, at_most=1.0
    ),
    'slip_bandwidth_rad_s': Option(
        10.0, 'bandwidth of the loop of the slip', 'rad/s', at_least=5.0, at_most=20.0
    ),
}
"""Tested to be stable at wear gains from 0.7 to 1.3: docs/controllers/state_of_art.md says why."""


class DecoupledPid(Controller):
    """
    Two PIDs whose outputs are the accelerations of engine and slip, and a decoupler.

    a_m = dw_m*/dt + PID(w_m* - w_m) and a_d = dw_d*/dt + PID(w_d* - w_d). The clutch gives the
    shaft a_m - dw_d*/dt, as far as `SlowClutch` passes it, and the engine gives the slip a_d:
    C_m = C_f + J_m ((C_f - C_load/tau)/J_eq + a_d), with the C_f that the actuator's model gives
    for the period. So the first PID does not move the slip, and the lag of the clutch neither.
    What the second does to the engine speed the first makes good; it waits while the engine is at
    its limit.
    """

    commands_engine = True

    def __init__(self, context: ControllerContext) -> None:
        """Tune the loops by the values of OPTIONS."""
        options = context.gains
        self._clutch = SlowClutch(context, options['engine_bandwidth_rad_s'])
        authority = context.settings.scenario.engine_authority
        slip_gains = placed_gains(options['slip_bandwidth_rad_s'], authority.lag_s)
        self._engine = EngineShare(self._clutch.transmission, authority, slip_gains)

    def reset(self) -> None:
        """Forget the plan, empty both integrals, put actuator and engine to rest."""
        self._clutch.reset()
        self._engine.reset()

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


SPEC = ControllerSpec('decoupled_pid', DecoupledPid, OPTIONS)
