"""Control architectures of Section 1.6: how open loop and feedback make one torque request."""

from dataclasses import dataclass

from ddct_controllers.interface import Command, Controller, Measurement, Status
from ddct_plant.checks import require_finite
from ddct_plant.load import RoadLoad
from ddct_plant.run_settings import RunSettings
from ddct_plant.static_torque import constant_slip_torque

_FEEDBACK_OFF = Command(0.0)


@dataclass(frozen=True, slots=True)
class TorqueRequest:
    """What the clutch is asked over one period, before saturation, and what it is made of."""

    torque: float
    """Sum of both parts in N m; the actuator cuts it off below zero."""
    status: Status
    """Pairs for `controller/status`: both parts, saturation, then the controller's own."""


class DetailedArchitecture:
    """
    C_f = C_fOL + C_fCL (Section 1.4.5.1): the static controller is always on.

    Feedback is held in reset until the scenario's `control_start_s`. The static controller takes
    C_m, and C_load computed from V_x and the slope.
    """

    def __init__(self, settings: RunSettings, controller: Controller) -> None:
        """Wire `controller` as the feedback of a run with these settings."""
        scenario = settings.scenario
        self._controller = controller
        self._driveline = scenario.driveline
        self._load = RoadLoad(scenario.load, scenario.vehicle)
        self._start_step = scenario.control_start_step

    def update(self, measurement: Measurement) -> TorqueRequest:
        """Return the request for the period that starts at the measurement's step."""
        load_torque = self._load.torque(measurement.vehicle_speed)
        open_loop = constant_slip_torque(self._driveline, measurement.engine_torque, load_torque)
        if measurement.step >= self._start_step:
            feedback = 'on'
            command = self._controller.update(measurement)
        else:
            feedback = 'held in reset'
            self._controller.reset()
            command = _FEEDBACK_OFF
        source = f"the controller's torque at step {measurement.step}"
        torque = open_loop + require_finite(source, command.clutch_torque)
        return TorqueRequest(
            torque,
            (
                ('feedback', feedback),
                ('open_loop_torque_n_m', repr(open_loop)),
                ('closed_loop_torque_n_m', repr(command.clutch_torque)),
                ('saturated', 'true' if torque < 0.0 else 'false'),
                *command.status,
            ),
        )
