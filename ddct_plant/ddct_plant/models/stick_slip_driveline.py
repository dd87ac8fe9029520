"""The driveline with a clutch that sticks and wheels that dry friction holds."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ddct_plant.base.timebase import SUBSTEP_S, SUBSTEPS
from ddct_plant.hybrid.friction_system import FrictionSystem
from ddct_plant.hybrid.integrator import HybridIntegrator
from ddct_plant.hybrid.motion import Event
from ddct_plant.models.driveline import DrivelineOutputs
from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.initial_state import InitialState
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.vehicle import VehicleParameters

CLUTCH, WHEEL = 0, 1
"""The friction elements by number."""
_STATES = 7
_HELD = (0, 1, 3)
"""Of C_m, C_load, clutch capacity, holding torque: all but the clutch capacity are held."""


class FrictionPeriod(NamedTuple):
    """What the friction elements did in the period that has ended; at t_0 nothing."""

    clutch_phase: str
    """`open`, `slipping` or `locked`, at its end."""
    wheel_phase: str
    """The same; `open` is a wheel that turns with neither rolling resistance nor brake."""
    events: list[Event]
    """In the order of time; element 0 is the clutch, 1 the wheel."""
    clutch_work: float
    """Exact friction work in J."""
    wheel_work: float
    """The same, of rolling resistance and brake together."""


class StickSlipDriveline:
    """
    The four states of Section 1.5 and the three angles, with two dry-friction elements.

    The clutch transmits its kinetic capacity against the slip w_m - w_p, and sticks at slip zero
    up to its static capacity. Rolling resistance and brake act on w_r in the same way with one
    capacity, the holding torque. C_m, C_load and the holding torque are held over a 10 ms period,
    the capacities of the clutch are linear between 11 nodes. Exact as `Driveline` is, events
    included.
    """

    def __init__(
        self,
        parameters: DrivelineParameters,
        vehicle: VehicleParameters,
        initial: InitialState,
        wheel_torque: float = 0.0,
    ) -> None:
        """
        Start in the given state; `wheel_torque` is the friction at the wheel before t_0, in N m.

        `initial.load_torque` is then that of air and slope alone.
        """
        self._parameters = parameters
        self._wheel_radius = vehicle.wheel_radius_m
        self._integrator = _integrator(parameters)
        self._state = np.zeros(_STATES)
        self._state[:4] = (
            initial.engine_speed,
            initial.shaft_speed,
            initial.wheel_speed,
            initial.twist,
        )
        self._signs = self._integrator.mode_of(self._state)
        self._torques = (initial.engine_torque, initial.load_torque)
        self._friction = [initial.clutch_torque, wheel_torque]
        self.period = FrictionPeriod(
            _phase(self._signs[CLUTCH], initial.clutch_torque),
            _phase(self._signs[WHEEL], wheel_torque),
            [],
            0.0,
            0.0,
        )

    def outputs(self) -> DrivelineOutputs:
        """
        Return the outputs at the present stamp.

        The wheel's effort is C_load with the friction there. While the clutch sticks the slip is
        0, and while the wheels stick so is the acceleration, not the rounding of differences.
        """
        engine, shaft, wheel, twist, *angles = self._state.tolist()
        p = self._parameters
        twist_speed = shaft / p.total_ratio - wheel
        shaft_torque = p.halfshaft_damping * twist_speed + p.halfshaft_stiffness * twist
        engine_torque, load_torque = self._torques
        load_torque += self._friction[WHEEL]
        wheel_accel = (shaft_torque - load_torque) / p.vehicle_inertia
        return DrivelineOutputs(
            positions=[*angles, twist],
            speeds=[engine, shaft, wheel, twist_speed],
            efforts=[engine_torque, self._friction[CLUTCH], load_torque, shaft_torque],
            slip_speed=engine - shaft if self._signs[CLUTCH] else 0.0,
            vehicle_speed=self._wheel_radius * wheel,
            vehicle_accel=self._wheel_radius * wheel_accel if self._signs[WHEEL] else 0.0,
        )

    def step(
        self,
        engine_torque: float,
        load_torque: float,
        kinetic_torque: Sequence[float],
        static_torque: Sequence[float],
        holding_torque: float,
    ) -> None:
        """
        Advance by 10 ms with held C_m and C_load and the (11,) nodes of the clutch's capacities.

        All in N m. `load_torque` is that of air and slope; `holding_torque`, the capacity of
        rolling resistance and brake at the wheel, is held too. Raise ParameterError for a
        negative capacity, or a static one below the kinetic one.
        """
        interval = self._integrator.advance(
            self._state,
            self._signs,
            (engine_torque, load_torque),
            (kinetic_torque, holding_torque),
            (static_torque, holding_torque),
        )
        self._state, self._signs = interval.states[-1], interval.signs
        self._torques = (engine_torque, load_torque)
        self._friction = interval.friction
        self.period = FrictionPeriod(
            _phase(self._signs[CLUTCH], kinetic_torque[-1]),
            _phase(self._signs[WHEEL], holding_torque),
            interval.events,
            *interval.work,
        )


def _phase(sign: int, capacity: float) -> str:
    if sign == 0:
        return 'locked'
    return 'slipping' if capacity else 'open'


def _integrator(parameters: DrivelineParameters) -> HybridIntegrator:
    model = driveline_matrices(parameters)
    a = np.zeros((_STATES, _STATES))
    a[:4, :4] = model.a
    a[4:7, :3] = np.eye(3)
    b = np.vstack([model.b, np.zeros((3, 3))])
    engine, clutch, load = b[:, 0:1], b[:, 1:2], b[:, 2:3]
    h = np.zeros((2, _STATES))
    h[CLUTCH, :2] = 1.0, -1.0
    h[WHEEL, 2] = 1.0
    system = FrictionSystem(a, np.hstack([engine, load]), np.hstack([clutch, load]), h)
    return HybridIntegrator(system, SUBSTEP_S, SUBSTEPS, _HELD)
