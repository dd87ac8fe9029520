"""The clutch torque that keeps the slip speed constant, from the plant's own equations."""

from ddct_plant.parameters import DrivelineParameters


def constant_slip_torque(
    parameters: DrivelineParameters, engine_torque: float, load_torque: float
) -> float:
    """
    Return C_fOL in N m, the torque at which w_m and w_p accelerate alike.

    With a rigid driveline and no damping, J_m dw/dt = C_m - C_f and
    (J_p + J_v/tau^2) dw/dt = C_f - C_load/tau, so
    C_fOL = [C_m (J_p + J_v/tau^2) + J_m C_load/tau] / (J_m + J_p + J_v/tau^2).
    The thesis derives its static controller from the plant's differential equations (Section
    1.4.5.1) and prints no formula.
    """
    ratio = parameters.total_ratio
    shaft_side = parameters.shaft_inertia + parameters.vehicle_inertia / ratio**2
    engine_side = parameters.engine_inertia
    return (engine_torque * shaft_side + engine_side * load_torque / ratio) / (
        engine_side + shaft_side
    )
