# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Covariance of the estimate of the torque that the clutch carries, of one run or of many."""

from typing import Any, NamedTuple

SPEED_NOISE_RAD_S = 0.1
"""Standard deviation of the measured w_m, twice what our other observers assume."""
ENGINE_TORQUE_NOISE_N_M = 3.0
"""Standard deviation of C_m per period."""
INITIAL_GAIN = 0.2
"""Standard deviation of the wear gain from 1 before the first measurement."""
INITIAL_OFFSET_N_M = 2.0
"""Standard deviation of the offset of the torque before the first measurement."""
LEAST_TORQUE_N_M = 5.0
"""Torque below which the wear gain does not drift: there it is not observable."""
AT_TORQUE_N_M = 100.0
"""Torque at which the drift of the offset is given: it is in proportion to the torque."""


class TorqueNoise(NamedTuple):
    """Drifts of the estimate, standard deviations per period; numbers, or arrays (R,)."""

    gain_drift: Any
    """Drift of the wear gain."""
    offset_drift_n_m: Any
    """Drift of the offset in N m at a torque of `AT_TORQUE_N_M`."""


class TorqueGains(NamedTuple):
    """Gains by which an error of the predicted w_m corrects w_m, g and d."""

    speed: Any
    gain: Any
    offset: Any


class TorqueCovariance(NamedTuple):
    """
    Covariance of w_m (s), the wear gain g and the offset d, as its six different entries.

    They are numbers, or arrays (R,) of R runs, to the same bits.
    """

    ss: Any = SPEED_NOISE_RAD_S**2
    sg: Any = 0.0
    sd: Any = 0.0
    gg: Any = INITIAL_GAIN**2
    gd: Any = 0.0
    dd: Any = INITIAL_OFFSET_N_M**2

    def at_measured_speed(self) -> 'TorqueCovariance':
        """Return the covariance where w_m is as measured."""
        return TorqueCovariance(gg=self.gg, gd=self.gd, dd=self.dd)

    def after_period(
        self, step: Any, torque: Any, noise: TorqueNoise
    ) -> tuple[TorqueGains, 'TorqueCovariance']:
        """
        Return the gains of a period in which the clutch slipped, and the covariance after it.

        `step` is the change of w_m in rad/s per N m, `torque` the actuator's mean one in N m.
        """
        # Prediction: w_m depends on g by -step f, and on d by -step.
        by_gain = step * torque
        sg = self.sg - by_gain * self.gg - step * self.gd
        sd = self.sd - by_gain * self.gd - step * self.dd
        ss = self.ss - by_gain * (self.sg + sg) - step * (self.sd + sd)
        ss = ss + (step * ENGINE_TORQUE_NOISE_N_M) ** 2
        gg = self.gg + noise.gain_drift**2 * (torque > LEAST_TORQUE_N_M)
        offset_drift = noise.offset_drift_n_m * torque / AT_TORQUE_N_M
        dd = self.dd + offset_drift * offset_drift
        # Correction by the measured speed.
        innovation = ss + SPEED_NOISE_RAD_S**2
        gains = TorqueGains(ss / innovation, sg / innovation, sd / innovation)
        return gains, TorqueCovariance(
            ss=ss - gains.speed * ss,
            sg=sg - gains.speed * sg,
            sd=sd - gains.speed * sd,
            gg=gg - gains.gain * sg,
            gd=self.gd - gains.gain * sd,
            dd=dd - gains.offset * sd,
        )
