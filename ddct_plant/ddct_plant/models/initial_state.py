"""The state a run starts from, as the models take it."""

from dataclasses import dataclass


@dataclass(frozen=True)
class InitialState:
    """
    Speeds, driveshaft twist and the torques that hold before t_0.

    The wheel turns with the primary shaft (w_sr = 0); theta_sr balances the load, and with the
    equilibrium `full` what accelerates the vehicle too. The actuator is at rest on
    `torque_request`, which the clutch transmits times the wear gain.
    """

    engine_speed: float
    """w_m(0) in rad/s."""
    shaft_speed: float
    """w_p(0) in rad/s."""
    wheel_speed: float
    """w_r(0) in rad/s."""
    twist: float
    """theta_sr(0) in rad."""
    engine_torque: float
    """C_m(0) in N m."""
    load_torque: float
    """C_load(0) in N m."""
    torque_request: float
    """What the clutch is asked before t_0, in N m: C_fOL(0) in `detailed`, 0 elsewhere."""
    clutch_torque: float
    """What it transmits then, in N m."""
