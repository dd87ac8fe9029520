"""Driveline: engine, primary shaft, wheel and driveshaft, stepped exactly (Section 1.5)."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S, SUBSTEPS
from ddct_plant.linear.lti import hold_inputs, lift_piecewise_linear
from ddct_plant.models.driveline_model import matrices_with_angles, states_and_torques
from ddct_plant.models.parameters import DrivelineParameters, VehicleParameters


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
    """
    What the clutch is asked before t_0, in N m: C_fOL(0) in `detailed`, 0 elsewhere and where the
    scenario calls the clutch open.
    """
    clutch_torque: float
    """What it transmits then, in N m."""
    wheel_torque: float = 0.0
    """Friction of rolling and brake at the wheel, in N m; 0 where C_load has the rolling in it."""
    clutch_open: bool = False
    """Whether it can transmit nothing then, though both plates may have one speed."""


PHASES = OPEN, SLIPPING, LOCKED = ('open', 'slipping', 'locked')
"""What the plates of a clutch that sticks can do; in signals by number."""
PHASE_EVENTS = LOCK, RELEASE, REVERSE = ('lock', 'release', 'reverse')
"""What happens at slip zero: the plates stick, part, or pass through it without sticking."""


class PhaseEvent(NamedTuple):
    """The plates of a clutch that sticks lock, part, or slip the other way from now on."""

    time_s: float
    """Scenario time."""
    kind: str
    """One of PHASE_EVENTS."""
    slip_acceleration: float | None = None
    """
    dw_d/dt in rad/s^2 just before it, of a release just after it.

    None where it is not known: bags recorded before it was part of the event do not have it.
    """


class DrivelineOutputs(NamedTuple):
    """The signals of a tick; joints in the order engine, primary shaft, wheel, driveshaft."""

    joint_position: list[float]
    """(4,) rad; the driveshaft's is theta_sr, the others integrate from 0."""
    joint_speed: list[float]
    """(4,) rad/s: w_m, w_p, w_r, w_sr."""
    joint_effort: list[float]
    """(4,) N m, left limits: C_m, transmitted C_f, C_load, shaft torque at the wheel."""
    slip_speed: float
    """w_d = w_m - w_p in rad/s."""
    vehicle_speed: float
    """V_x in m/s."""
    vehicle_accel: float
    """A_x in m/s^2, left limit."""
    clutch_phase: float | None = None
    """Number of the phase in `PHASES`; this and what follows is None for the linear clutch."""
    friction_work: float | None = None
    """Exact friction work in J of the period that has ended."""
    phase_events: tuple[PhaseEvent, ...] | None = None
    """What happened at slip zero in it, in the order of time."""


def driveline_outputs(
    parameters: DrivelineParameters,
    wheel_radius: float,
    state: Sequence[float],
    torques: tuple[float, float, float],
    clutch_sticks: bool = False,
    wheels_stick: bool = False,
    clutch_phase: float | None = None,
    friction_work: float | None = None,
    phase_events: tuple[PhaseEvent, ...] | None = None,
) -> DrivelineOutputs:
    """
    Return the outputs in a state (7,) with C_m, C_f and C_load just before, in N m.

    The last three are for a clutch that sticks, as `DrivelineOutputs` has them.

    While the clutch sticks the slip is 0, and while the wheels stick the acceleration is, not the
    rounding of a difference.
    """
    engine, shaft, wheel, twist, *angles = state
    p = parameters
    twist_speed = shaft / p.total_ratio - wheel
    shaft_torque = p.halfshaft_damping * twist_speed + p.halfshaft_stiffness * twist
    engine_torque, clutch_torque, load_torque = torques
    wheel_accel = 0.0 if wheels_stick else (shaft_torque - load_torque) / p.vehicle_inertia
    return DrivelineOutputs(
        joint_position=[*angles, twist],
        joint_speed=[engine, shaft, wheel, twist_speed],
        joint_effort=[engine_torque, clutch_torque, load_torque, shaft_torque],
        slip_speed=0.0 if clutch_sticks else engine - shaft,
        vehicle_speed=wheel_radius * wheel,
        vehicle_accel=wheel_radius * wheel_accel,
        clutch_phase=clutch_phase,
        friction_work=friction_work,
        phase_events=phase_events,
    )


class Driveline:
    """
    The four states of Section 1.5 and the three angles, in one exact integrator.

    Over a 10 ms period C_m and C_load are held and C_f is piecewise linear between 11 nodes, so
    the step is one matrix product. The 88 rad/s mode would lose 0.9 rad of phase per period if
    the inertias were integrated in separate nodes.
    """

    def __init__(
        self, parameters: DrivelineParameters, vehicle: VehicleParameters, initial: InitialState
    ) -> None:
        """Start in the given state."""
        self._parameters = parameters
        self._wheel_radius = vehicle.wheel_radius_m
        self._step_matrix = step_matrix(parameters)
        self._state_and_inputs = np.zeros(self._step_matrix.shape[1])
        self._state_and_inputs[:4] = (
            initial.engine_speed,
            initial.shaft_speed,
            initial.wheel_speed,
            initial.twist,
        )
        self._torques = (initial.engine_torque, initial.clutch_torque, initial.load_torque)

    @property
    def engine_speed(self) -> float:
        """w_m in rad/s at the present stamp."""
        return float(self._state_and_inputs[0])

    def outputs(self) -> DrivelineOutputs:
        """Return the outputs at the present stamp."""
        state = self._state_and_inputs[:7].tolist()
        return driveline_outputs(self._parameters, self._wheel_radius, state, self._torques)

    def step(
        self, engine_torque: float, load_torque: float, clutch_torque: Sequence[float]
    ) -> None:
        """Advance by 10 ms with held C_m and C_load and the (11,) nodes of C_f, all in N m."""
        values = self._state_and_inputs
        values[7] = engine_torque
        values[8] = load_torque
        values[9:] = clutch_torque
        values[:7] = self._step_matrix @ values
        self._torques = (engine_torque, clutch_torque[-1], load_torque)


def step_matrix(parameters: DrivelineParameters, *, angles: bool = True) -> np.ndarray:
    """
    Return the (..., 7, 20) map to the next states and angles, (..., 4, 17) without the angles.

    It takes states and angles (7,), C_m, C_load and the C_f nodes. Parameters that are arrays,
    (...), give a stack. Raise ParameterError where a number is not finite.
    """
    a, b = matrices_with_angles(parameters) if angles else states_and_torques(parameters)
    _require_finite(a, b)
    engine, clutch, load = b[..., 0:1], b[..., 1:2], b[..., 2:3]
    _, held = hold_inputs(a, np.concatenate([engine, load], axis=-1), PERIOD_S)
    transition, nodes = lift_piecewise_linear(a, clutch, PERIOD_S, SUBSTEPS)
    _require_finite(transition, held, nodes)
    return np.concatenate([transition, held, nodes], axis=-1)


def _require_finite(*matrices: np.ndarray) -> None:
    if not all(np.isfinite(matrix).all() for matrix in matrices):
        raise ParameterError('driveline: its matrices have numbers that are not finite')
