"""One closed-loop run as plain arrays: the headless loop makes it, a bag holds it."""

import dataclasses
import hashlib
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Trajectory:
    """
    Every signal of a run at the stamps t_0..t_N; row k is step k, so N + 1 rows, all SI.

    States, slip and vehicle signals hold at t_k (efforts and `vehicle_accel` are left limits);
    torques, reference and request answer t_k and apply over [t_k, t_k+1]. Replies to t_N are kept
    although nothing applied them.
    """

    joint_position: np.ndarray
    """(N+1, 4) rad; driveshaft is theta_sr, the others integrate from 0."""
    joint_speed: np.ndarray
    """(N+1, 4) rad/s: w_m, w_p, w_r, w_sr."""
    joint_effort: np.ndarray
    """(N+1, 4) N m: C_m, transmitted C_f, C_load, shaft torque."""
    slip_speed: np.ndarray
    """(N+1,) rad/s, w_d = w_m - w_p."""
    vehicle_speed: np.ndarray
    """(N+1,) m/s, V_x."""
    vehicle_accel: np.ndarray
    """(N+1,) m/s^2, A_x."""
    torque_demand: np.ndarray
    """(N+1,) N m, the driver's demand at t_k."""
    engine_torque: np.ndarray
    """(N+1,) N m, C_m held over the period."""
    load_torque: np.ndarray
    """(N+1,) N m, C_load held over the period."""
    slip_reference: np.ndarray
    """(N+1, P+1) rad/s, column i is i x 10 ms ahead."""
    slip_reference_rate: np.ndarray
    """(N+1, P+1) rad/s^2."""
    torque_request: np.ndarray
    """(N+1,) N m, before saturation."""
    actuator_torque: np.ndarray
    """(N+1, 11) N m at 0, 1, ..., 10 ms after t_k."""
    clutch_torque: np.ndarray
    """(N+1, 11) N m, as `actuator_torque`, after wear."""
    status: tuple[tuple[tuple[str, str], ...], ...]
    """Per step the (key, value) pairs of `controller/status`."""
    engine_torque_request: np.ndarray | None = None
    """(N+1,) N m asked of the engine; None with a controller that does not command it."""

    @property
    def steps(self) -> int:
        """N, the number of periods integrated."""
        return len(self.slip_speed) - 1

    @property
    def time_s(self) -> np.ndarray:
        """(N+1,) scenario time in s."""
        return np.arange(self.steps + 1) / 100.0

    def sha256(self) -> str:
        """Return the hash over every array to the last bit and every status pair."""
        digest = hashlib.sha256()
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if value is None:
                continue
            digest.update(field.name.encode())
            if isinstance(value, np.ndarray):
                digest.update(repr(value.shape).encode())
                digest.update(np.ascontiguousarray(value, dtype='<f8').tobytes())
            else:
                digest.update(repr(value).encode())
        return digest.hexdigest()
