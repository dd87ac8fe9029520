# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Signals of a driveline at a tick: its joints, slip, vehicle, and the events of its clutch."""

from collections.abc import Sequence
from typing import Any, NamedTuple

from ddct_plant.models.parameters import DrivelineParameters

PHASES = OPEN, SLIPPING, LOCKED = ('open', 'slipping', 'locked')
"""Phases of a stick-slip clutch; a signal has the index of the phase."""
PHASE_EVENTS = LOCK, RELEASE, REVERSE = ('lock', 'release', 'reverse')
"""Kinds of events at slip zero: the plates lock, release, or reverse their slip without
locking."""


class PhaseEvent(NamedTuple):
    """Event of a stick-slip clutch at slip zero: lock, release or reverse."""

    time_s: float
    """Scenario time of the event in s."""
    kind: str
    """Kind of the event: one of PHASE_EVENTS."""
    slip_acceleration: float | None = None
    """
    Slip acceleration dw_d/dt in rad/s^2 just before the event, or just after a release.

    None in bags of older versions, which do not have it.
    """


class JointValues(NamedTuple):
    """Values of one quantity by joint; their order is that of the joints in messages."""

    engine: float
    primary_shaft: float
    wheel: float
    driveshaft: float


class SensedJoints(NamedTuple):
    """Values of one quantity by joint with a speed sensor, in the order of their message."""

    engine: float
    primary_shaft: float
    wheel: float


class OffGoingOutputs(NamedTuple):
    """Signals of the off-going clutch and its shaft at a tick of a shift."""

    shaft_angle: float
    """Angle of the off-going primary shaft in rad, from 0."""
    shaft_speed: float
    """Speed w_p1 of the off-going primary shaft in rad/s."""
    transmitted_torque: float
    """Transmitted torque C_1 in N m, left limit; negative where it takes torque from the
    wheels."""
    slip_speed: float
    """Slip speed w_m - w_p1 in rad/s."""
    clutch_phase: float
    """Index of the phase in `PHASES`."""
    friction_work: float
    """Exact friction work in J of the last period."""
    phase_events: tuple[PhaseEvent, ...]
    """Events at slip zero in the last period, in the order of time."""


class DrivelineOutputs(NamedTuple):
    """The signals of a tick; in a shift shaft, slip and clutch are those of the on-coming side."""

    joint_position: JointValues
    """Angles in rad: theta_sr of the driveshaft, the others integrated from 0."""
    joint_speed: JointValues
    """Speeds w_m, w_p, w_r, w_sr in rad/s."""
    joint_effort: JointValues
    """Torques in N m, left limits: C_m, transmitted C_f, C_load, shaft torque at the wheel."""
    slip_speed: float
    """Slip speed w_d = w_m - w_p in rad/s."""
    vehicle_speed: float
    """Vehicle speed V_x in m/s."""
    vehicle_accel: float
    """Vehicle acceleration A_x in m/s^2, left limit."""
    clutch_phase: float | None = None
    """Index of the phase in `PHASES`; None for the linear clutch, as are the next two fields."""
    friction_work: float | None = None
    """Exact friction work in J of the last period."""
    phase_events: tuple[PhaseEvent, ...] | None = None
    """Events at slip zero in the last period, in the order of time."""
    off_going: OffGoingOutputs | None = None
    """Signals of the off-going side of a shift; None without a shift, as is the next field."""
    tie_up_work: float | None = None
    """Exact work in J of the clutches against each other in the last period, see `TieUp`."""

    @classmethod
    def of_state(
        cls,
        parameters: DrivelineParameters,
        wheel_radius: float,
        state: Sequence[float],
        torques: tuple[float, float, float],
        clutch_sticks: bool = False,
        wheels_stick: bool = False,
        clutch_phase: float | None = None,
        friction_work: float | None = None,
        phase_events: tuple[PhaseEvent, ...] | None = None,
        gear_speed: float | None = None,
        off_going: OffGoingOutputs | None = None,
        tie_up_work: float | None = None,
    ) -> 'DrivelineOutputs':
        """
        Return the outputs in a state (7,), with the left limits of C_m, C_f and C_load in N m.

        The fields `clutch_phase`, `friction_work` and `phase_events` are for a clutch that sticks,
        `off_going` and `tie_up_work` for a shift. The slip is exactly 0 while the clutch sticks,
        and the acceleration while the wheels stick. `gear_speed` is that of the driveshaft's inner
        end in rad/s; by default the primary shaft turns it.
        """
        engine, shaft, wheel, twist, engine_angle, shaft_angle, wheel_angle = state
        p = parameters
        if gear_speed is None:
            gear_speed = p.gear.wheel_speed(shaft)
        twist_speed = gear_speed - wheel
        shaft_torque = p.halfshaft_damping * twist_speed + p.halfshaft_stiffness * twist
        engine_torque, clutch_torque, load_torque = torques
        wheel_accel = 0.0 if wheels_stick else (shaft_torque - load_torque) / p.vehicle_inertia
        return cls(
            joint_position=JointValues(engine_angle, shaft_angle, wheel_angle, twist),
            joint_speed=JointValues(engine, shaft, wheel, twist_speed),
            joint_effort=JointValues(engine_torque, clutch_torque, load_torque, shaft_torque),
            slip_speed=0.0 if clutch_sticks else engine - shaft,
            vehicle_speed=wheel_radius * wheel,
            vehicle_accel=wheel_radius * wheel_accel,
            clutch_phase=clutch_phase,
            friction_work=friction_work,
            phase_events=phase_events,
            off_going=off_going,
            tie_up_work=tie_up_work,
        )

    @property
    def signals(self) -> dict[str, Any]:
        """Signals of the tick by name; those of the off-going side have a prefix."""
        named = self._asdict()
        if off_going := named.pop('off_going'):
            named.update(zip(_OFF_GOING_SIGNALS, off_going, strict=True))
        return named

    @property
    def engine_speed(self) -> float:
        """Engine speed w_m in rad/s."""
        return self.joint_speed.engine

    @property
    def shaft_speed(self) -> float:
        """Speed of the primary shaft w_p in rad/s."""
        return self.joint_speed.primary_shaft

    @property
    def wheel_speed(self) -> float:
        """Wheel speed w_r in rad/s."""
        return self.joint_speed.wheel

    @property
    def twist(self) -> float:
        """Twist of the driveshaft theta_sr in rad."""
        return self.joint_position.driveshaft


_OFF_GOING_SIGNALS = tuple(f'off_going_{name}' for name in OffGoingOutputs._fields)
