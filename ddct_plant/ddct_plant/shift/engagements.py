# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The linear systems of a shift, with three friction elements: one gear engaged, or both."""

from collections.abc import Sequence
from functools import lru_cache
from typing import Protocol

import numpy as np

from ddct_plant.base.timebase import SUBSTEP_S, SUBSTEPS
from ddct_plant.hybrid.friction_system import FrictionSystem
from ddct_plant.hybrid.integrator import HybridIntegrator
from ddct_plant.linear.names import Names
from ddct_plant.models.driveline_model import STATES_AND_ANGLES, TORQUES, matrices_with_angles
from ddct_plant.models.gearbox import EngagedGear
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.shift.gear_pair import GearPair

ON_COMING, OFF_GOING, WHEEL = 0, 1, 2
"""Indices of the friction elements: the two clutches, and rolling resistance with the brake."""
OTHER_SHAFT = Names(('off_going_speed', 'off_going_angle'))
SHIFT_STATES = STATES_AND_ANGLES + OTHER_SHAFT
"""
States of a shift: those of the driveline, whose primary shaft is the on-coming one, then speed in
rad/s and angle in rad of the off-going primary shaft.
"""
_HELD = (0, 1, 4)
"""Indices of the entries held over a period: C_m, C_load and the holding torque."""
_DRIVEN = len(STATES_AND_ANGLES)
_ENGINE, _SHAFT, _ANGLE = STATES_AND_ANGLES.places('engine_speed', 'shaft_speed', 'shaft_angle')
_ALONE, _ALONE_ANGLE = OTHER_SHAFT.places('off_going_speed', 'off_going_angle')
_SWAPPED = list(range(len(SHIFT_STATES)))
_SWAPPED[_SHAFT], _SWAPPED[_ANGLE] = _DRIVEN + _ALONE, _DRIVEN + _ALONE_ANGLE
_SWAPPED[_DRIVEN + _ALONE], _SWAPPED[_DRIVEN + _ALONE_ANGLE] = _SHAFT, _ANGLE
"""Places of SHIFT_STATES with the two primary shafts exchanged."""


class EngagedGears(Protocol):
    """Engaged gears: integrator of their system, its states from and to SHIFT_STATES."""

    integrator: HybridIntegrator
    """Integrator of the system with the friction elements of both clutches and the wheels."""

    def of_shift(self, values: Sequence[float]) -> list[float]:
        """Return the state of the system for the values (9,) of SHIFT_STATES."""

    def to_shift(self, state: Sequence[float]) -> list[float]:
        """Return the values (9,) of SHIFT_STATES for a state of the system."""

    def gear_speed(self, values: Sequence[float]) -> float:
        """Return the speed w_g in rad/s of the driveshaft's inner end, for SHIFT_STATES (9,)."""


class BothEngaged:
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
        self._gear = gears.on_coming.gear
        a, engine, clutch, load = _with_states(gears.both_engaged, 1)
        a[_DRIVEN, _SHAFT] = ratio
        off_going = clutch.copy()
        off_going[_SHAFT] *= ratio
        on_coming_slip, off_going_slip = _slip(_SHAFT, len(a)), _slip(_SHAFT, len(a), ratio)
        self.integrator = _integrator(
            a, engine, load, (clutch, off_going), (on_coming_slip, off_going_slip)
        )

    def of_shift(self, values: Sequence[float]) -> list[float]:
        """Return the state; the gears give the on-coming shaft the speed of the off-going one."""
        state = [*values[:_DRIVEN], values[_DRIVEN + _ALONE_ANGLE]]
        state[_SHAFT] = values[_DRIVEN + _ALONE] / self._ratio
        return state

    def to_shift(self, state: Sequence[float]) -> list[float]:
        """Return the values of SHIFT_STATES."""
        return [*state[:_DRIVEN], self._ratio * state[_SHAFT], state[_DRIVEN]]

    def gear_speed(self, values: Sequence[float]) -> float:
        """Return w_g in rad/s."""
        return self._gear.wheel_speed(values[_SHAFT])


class OneEngaged:
    """
    One gear engaged: the driveline in that gear, and the other primary shaft free of the wheels.

    The free shaft turns by its own inertia: J_p dw/dt = C - c_prim w with the torque C of its
    clutch. With that clutch open the rest is the driveline with one clutch.
    """

    def __init__(self, parameters: DrivelineParameters, places: Sequence[int]) -> None:
        """Prepare the integrator; `places` are those of its states in SHIFT_STATES."""
        self._gear: EngagedGear = parameters.gear
        self._places = list(places)
        self._turning = self._places[_SHAFT]
        a, engine, engaged, load = _with_states(parameters, 2)
        alone, angle = _DRIVEN + _ALONE, _DRIVEN + _ALONE_ANGLE
        a[alone, alone] = -parameters.shaft_damping / parameters.shaft_inertia
        a[angle, alone] = 1.0
        free = -engine
        free[alone] = 1.0 / parameters.shaft_inertia
        clutches = engaged, free
        slips = _slip(_SHAFT, len(a)), _slip(alone, len(a))
        if self._turning != _SHAFT:
            clutches, slips = clutches[::-1], slips[::-1]
        self.integrator = _integrator(a, engine, load, clutches, slips)

    def of_shift(self, values: Sequence[float]) -> list[float]:
        """Return the state: the values in another order."""
        return [values[place] for place in self._places]

    def to_shift(self, state: Sequence[float]) -> list[float]:
        """Return the values of SHIFT_STATES; exchanging the shafts twice changes nothing."""
        return self.of_shift(state)

    def gear_speed(self, values: Sequence[float]) -> float:
        """Return w_g in rad/s."""
        return self._gear.wheel_speed(values[self._turning])


@lru_cache
def off_going_engaged(gears: GearPair) -> OneEngaged:
    """Return the engagement before preselection: the on-coming shaft is free."""
    return OneEngaged(gears.in_off_going_gear, _SWAPPED)


@lru_cache
def both_engaged(gears: GearPair) -> BothEngaged:
    """Return the engagement during the shift."""
    return BothEngaged(gears)


@lru_cache
def on_coming_engaged(gears: GearPair) -> OneEngaged:
    """Return the engagement once the off-going gear is disengaged: its shaft is free."""
    return OneEngaged(gears.on_coming, range(len(SHIFT_STATES)))


def _with_states(parameters: DrivelineParameters, added: int) -> tuple[np.ndarray, ...]:
    """Return a and the columns of C_m, C_f and C_load with further states, which are zero."""
    driven, torques = matrices_with_angles(parameters)
    a = np.pad(driven, (0, added))
    b = np.pad(torques, ((0, added), (0, 0)))
    return a, *(b[:, TORQUES.column(name)] for name in TORQUES)


def _slip(shaft: int, size: int, ratio: float = 1.0) -> np.ndarray:
    """Return the row (n,) of a clutch's slip: w_m less `ratio` times the speed of a shaft."""
    row = np.zeros(size)
    row[[_ENGINE, shaft]] = 1.0, -ratio
    return row


def _integrator(
    a: np.ndarray,
    engine: np.ndarray,
    load: np.ndarray,
    clutches: Sequence[np.ndarray],
    slips: Sequence[np.ndarray],
) -> HybridIntegrator:
    """Return the integrator of a system; the wheels are its last friction element."""
    wheels = np.zeros(len(a))
    wheels[STATES_AND_ANGLES['wheel_speed']] = 1.0
    system = FrictionSystem(
        a, np.hstack([engine, load]), np.hstack([*clutches, load]), np.array([*slips, wheels])
    )
    return HybridIntegrator(system, SUBSTEP_S, SUBSTEPS, _HELD)
