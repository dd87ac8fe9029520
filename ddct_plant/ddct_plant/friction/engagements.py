# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The linear systems of the driveline with friction, by the gears that are engaged."""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from ddct_plant.base.timebase import SUBSTEP_S, SUBSTEPS
from ddct_plant.hybrid.friction_system import FrictionSystem
from ddct_plant.hybrid.integrator import HybridIntegrator
from ddct_plant.linear.names import Names
from ddct_plant.models.driveline_model import STATES_AND_ANGLES, TORQUES, matrices_with_angles
from ddct_plant.models.gearbox import EngagedGear
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.shift.gear_pair import GearPair

ON_COMING, OFF_GOING, WHEEL = 0, 1, -1
"""
Indices of the friction elements: the clutches, and rolling resistance with the brake.

A launch has the first clutch alone; the wheels are the last element.
"""
OTHER_SHAFT = Names(('off_going_speed', 'off_going_angle'))
SHIFT_STATES = STATES_AND_ANGLES + OTHER_SHAFT
"""
States of a shift: those of the driveline, whose primary shaft is the on-coming one, then speed in
rad/s and angle in rad of the off-going primary shaft.
"""
_DRIVEN = len(STATES_AND_ANGLES)
_ENGINE, _SHAFT, _ANGLE = STATES_AND_ANGLES.places('engine_speed', 'shaft_speed', 'shaft_angle')
_ALONE, _ALONE_ANGLE = OTHER_SHAFT.places('off_going_speed', 'off_going_angle')
_SWAPPED = list(range(len(SHIFT_STATES)))
_SWAPPED[_SHAFT], _SWAPPED[_ANGLE] = _DRIVEN + _ALONE, _DRIVEN + _ALONE_ANGLE
_SWAPPED[_DRIVEN + _ALONE], _SWAPPED[_DRIVEN + _ALONE_ANGLE] = _SHAFT, _ANGLE
"""Places of SHIFT_STATES with the two primary shafts exchanged."""


class EngagedGears:
    """
    Engaged gears: their system with the friction elements of each clutch and of the wheels.

    `values` are those of STATES_AND_ANGLES with one clutch, of SHIFT_STATES with two. The system
    may have other states.
    """

    def __init__(
        self, driveline: DrivelineParameters, gear: EngagedGear, system: FrictionSystem
    ) -> None:
        """
        Prepare the integrator of a system in which `gear` turns the wheels.

        `driveline` is that in the on-coming gear. Raise ParameterError where the rates are too
        fast for pieces of 1 ms.
        """
        self.driveline = driveline
        """Driveline in the on-coming gear, in a launch in its one gear."""
        self.clutches = system.elements - 1
        """Number of clutches, 1 or 2."""
        inputs = system.b.shape[1]
        held = (*range(inputs), inputs + self.clutches)  # C_m, C_load and the holding torque
        self.integrator = HybridIntegrator(system, SUBSTEP_S, SUBSTEPS, held)
        """Integrator of the system, whose elements are the clutches and then the wheels."""
        self.gear, self.turning = gear, _SHAFT
        """Gear that turns the wheels, and the place in the values of its shaft's speed."""

    def of_values(self, values: Sequence[float]) -> list[float]:
        """Return the state of the system for the values."""
        return list(values)

    def to_values(self, state: list[float]) -> list[float]:
        """Return the values for a state of the system."""
        return state


class BothEngaged(EngagedGears):
    """
    Both gears engaged: the primary shafts turn together, w_p1 = r w_p2 with r = tau_i/tau_j.

    With w_sr = w_p2/tau_j - w_r and C_s = c_sa w_sr + k_sa theta_sr,
    J_m dw_m/dt = C_m - c_m w_m - C_1 - C_2, J_v dw_r/dt = C_s - C_load and, at the on-coming
    shaft, J_p (1 + r^2) dw_p2/dt = r C_1 + C_2 - c_prim (1 + r^2) w_p2 - C_s/tau_j. The slips are
    w_m - r w_p2 and w_m - w_p2, so both clutches stick together at rest only.
    """

    def __init__(self, gears: GearPair) -> None:
        """Prepare the integrator."""
        self._ratio = ratio = gears.ratio
        a, engine, clutch, load = _with_states(gears.both_engaged, 1)
        a[_DRIVEN, _SHAFT] = ratio
        off_going = clutch.copy()
        off_going[_SHAFT] *= ratio
        slips = _slip(_SHAFT, len(a)), _slip(_SHAFT, len(a), ratio)
        system = _system(a, engine, load, (clutch, off_going), slips)
        super().__init__(gears.on_coming, gears.on_coming.gear, system)

    def of_values(self, values: Sequence[float]) -> list[float]:
        """Return the state; the gears give the on-coming shaft the speed of the off-going one."""
        state = [*values[:_DRIVEN], values[_DRIVEN + _ALONE_ANGLE]]
        state[_SHAFT] = values[_DRIVEN + _ALONE] / self._ratio
        return state

    def to_values(self, state: list[float]) -> list[float]:
        """Return the values of SHIFT_STATES."""
        return [*state[:_DRIVEN], self._ratio * state[_SHAFT], state[_DRIVEN]]


class OneOfTwoEngaged(EngagedGears):
    """
    One gear of a shift engaged, and the other primary shaft free of the wheels.

    The free shaft turns by its own inertia: J_p dw/dt = C - c_prim w with the torque C of its
    clutch. With that clutch open the rest is the driveline with one clutch.
    """

    def __init__(self, gears: GearPair, *, off_going: bool) -> None:
        """Prepare the integrator, with the off-going gear engaged or the on-coming one."""
        engaged = gears.in_off_going_gear if off_going else gears.on_coming
        # Exchanging the shafts twice changes nothing, so these are the places either way.
        self._places = _SWAPPED if off_going else range(len(SHIFT_STATES))
        a, engine, turning, load = _with_states(engaged, 2)
        alone, angle = _DRIVEN + _ALONE, _DRIVEN + _ALONE_ANGLE
        a[alone, alone] = -engaged.shaft_damping / engaged.shaft_inertia
        a[angle, alone] = 1.0
        free = -engine
        free[alone] = 1.0 / engaged.shaft_inertia
        clutches = turning, free
        slips = _slip(_SHAFT, len(a)), _slip(alone, len(a))
        if off_going:
            clutches, slips = clutches[::-1], slips[::-1]
        system = _system(a, engine, load, clutches, slips)
        super().__init__(gears.on_coming, engaged.gear, system)
        self.turning = self._places[_SHAFT]

    def of_values(self, values: Sequence[float]) -> list[float]:
        """Return the state: the values in another order."""
        return [values[place] for place in self._places]

    def to_values(self, state: list[float]) -> list[float]:
        """Return the values of SHIFT_STATES."""
        return self.of_values(state)


def one_clutch_system(parameters: DrivelineParameters) -> FrictionSystem:
    """Return the driveline with one clutch as a linear system with two friction elements."""
    a, engine, clutch, load = _with_states(parameters, 0)
    return _system(a, engine, load, (clutch,), (_slip(_SHAFT, len(a)),))


@lru_cache
def one_clutch(parameters: DrivelineParameters) -> EngagedGears:
    """Return the engagement of a launch: one clutch, and the gear behind it."""
    return EngagedGears(parameters, parameters.gear, one_clutch_system(parameters))


@lru_cache
def off_going_engaged(gears: GearPair) -> EngagedGears:
    """Return the engagement before preselection: the on-coming shaft is free."""
    return OneOfTwoEngaged(gears, off_going=True)


@lru_cache
def both_engaged(gears: GearPair) -> EngagedGears:
    """Return the engagement during the shift."""
    return BothEngaged(gears)


@lru_cache
def on_coming_engaged(gears: GearPair) -> EngagedGears:
    """Return the engagement once the off-going gear is disengaged: its shaft is free."""
    return OneOfTwoEngaged(gears, off_going=False)


def _with_states(parameters: DrivelineParameters, added: int) -> tuple[np.ndarray, ...]:
    """Return a and the columns of C_m, C_f and C_load with further states, which are zero."""
    driven, torques = matrices_with_angles(parameters)
    size = len(driven)
    a = np.zeros((size + added, size + added))
    b = np.zeros((size + added, torques.shape[1]))
    a[:size, :size], b[:size] = driven, torques
    return a, *(b[:, TORQUES.column(name)] for name in TORQUES)


def _slip(shaft: int, size: int, ratio: float = 1.0) -> np.ndarray:
    """Return the row (n,) of a clutch's slip: w_m less `ratio` times the speed of a shaft."""
    row = np.zeros(size)
    row[[_ENGINE, shaft]] = 1.0, -ratio
    return row


def _system(
    a: np.ndarray,
    engine: np.ndarray,
    load: np.ndarray,
    clutches: Sequence[np.ndarray],
    slips: Sequence[np.ndarray],
) -> FrictionSystem:
    """Return a system with these clutches, whose last element is the wheels."""
    wheels = np.zeros(len(a))
    wheels[STATES_AND_ANGLES['wheel_speed']] = 1.0
    return FrictionSystem(
        a, np.hstack([engine, load]), np.hstack([*clutches, load]), np.array([*slips, wheels])
    )
