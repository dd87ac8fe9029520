# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The closing stage: once both plates turn at the same speed, a request that keeps it so."""

from ddct_controllers.interface import Measurement, Status
from ddct_plant.base.timebase import PERIOD_S, steps_in
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.control import ClosingParameters


class ClosingStage:
    """
    The torque added to the open loop with which a locked clutch stays locked.

    A locked clutch carries C_fOL, so it slips when the request is below |C_fOL|. The margin is the
    request less |C_fOL|.

    - The stage closes when slip speed and reference have been within the band for the dwell time
      with feedback on. A reference beyond the band still demands slip.
    - While it is closed, the request continues from its last value without a jump, and the margin
      moves along the ramp to its target. The target is at least the margin at which the stage
      closed: that is what a worn clutch needed to lock.
    - When the clutch slips all the same, the margin was too small, and only feedback can find by
      how much. The stage opens, and what it added fades along the ramp while feedback acts.
    """

    def __init__(
        self, parameters: ClosingParameters, static_torque: StaticTorque, most_request: float
    ) -> None:
        """Start open; `most_request` in N m is the highest request of the stage."""
        self._parameters, self._most = parameters, most_request
        self._static_torque = static_torque
        self._dwell_steps = steps_in('closing.dwell_s', parameters.dwell_s)
        self._fade_steps = steps_in('closing.engine_fade_s', parameters.engine_fade_s)
        self._most_change = parameters.ramp_n_m_s * PERIOD_S
        self._samples_within = 0
        self._added = self._margin = self._least_margin = self._margin_left = 0.0
        self.closed = False
        """Whether the clutch counts as locked, so that feedback is off."""

    def update(
        self,
        measurement: Measurement,
        load_torque: float,
        open_loop: float,
        last_request: float,
        *,
        feedback_on: bool,
    ) -> float:
        """
        Return the torque in N m that is added to the open loop over the coming period.

        C_load, the open loop and the request of the last period in N m; `feedback_on` is whether
        the architecture has started feedback.
        """
        # Feedback that requests more than the stage may is not at the limit of slip: it stays on.
        in_reach = self.closed or last_request <= self._most
        within = feedback_on and in_reach and self._within_band(measurement)
        self._samples_within = self._samples_within + 1 if within else 0
        was_closed, self.closed = self.closed, self._samples_within > self._dwell_steps
        if not self.closed:
            self._added = self._along_ramp(self._added, 0.0)
            return self._added
        carried = abs(
            self._static_torque.torque(
                measurement.engine_torque,
                load_torque,
                measurement.engine_speed,
                measurement.shaft_speed,
            )
        )
        if not was_closed:
            self._margin = self._least_margin = max(last_request, 0.0) - carried
        target = self._target_margin(carried)
        self._margin = self._along_ramp(self._margin, target)
        self._margin_left = target - self._margin
        self._added = carried + self._margin - open_loop
        return self._added

    @property
    def engine_share(self) -> float:
        """Remaining share of the controller's last deviation of C_m from the driver's demand."""
        passed = self._samples_within - self._dwell_steps
        return max(1.0 - passed / self._fade_steps, 0.0) if self._fade_steps else 0.0

    @property
    def status(self) -> Status:
        """Pair for `controller/status`: the state of the stage."""
        if self.closed:
            state = 'closing' if self._margin_left else 'closed'
        else:
            state = 'opening' if self._added else 'open'
        return (('closing', state),)

    def _within_band(self, measurement: Measurement) -> bool:
        band = self._parameters.slip_band_rad_s
        return abs(measurement.slip_speed) <= band and abs(measurement.slip_reference[0]) <= band

    def _target_margin(self, carried: float) -> float:
        """Return the target margin over |C_fOL| in N m within the clutch's capacity."""
        p = self._parameters
        target = max((p.margin - 1.0) * carried + p.reserve_n_m, self._least_margin)
        return max(min(target, self._most - carried), 0.0)

    def _along_ramp(self, torque: float, target: float) -> float:
        """Return the torque in N m a period later, on its ramp to the target."""
        if abs(target - torque) <= self._most_change:
            return target
        return torque + (self._most_change if target > torque else -self._most_change)
