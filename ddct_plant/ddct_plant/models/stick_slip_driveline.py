# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The driveline with dry friction in the clutch and at the wheels."""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from ddct_plant.base.timebase import SUBSTEP_S, SUBSTEPS, time_of_step
from ddct_plant.hybrid.friction_system import FrictionSystem
from ddct_plant.hybrid.integrator import HybridIntegrator
from ddct_plant.hybrid.interval_map import Event, Interval
from ddct_plant.models.driveline import (
    LOCKED,
    OPEN,
    PHASES,
    SLIPPING,
    DrivelineOutputs,
    PhaseEvent,
    driveline_outputs,
)
from ddct_plant.models.driveline_model import (
    ANGLES,
    STATES_AND_ANGLES,
    TORQUES,
    matrices_with_angles,
)
from ddct_plant.models.initial_state import InitialState
from ddct_plant.models.parameters import DrivelineParameters, VehicleParameters

CLUTCH, WHEEL = 0, 1
"""Indices of the friction elements."""
_HELD = (0, 1, 3)
"""Indices of the inputs held over a period: C_m, C_load and holding torque."""
_ENGINE_SPEED = STATES_AND_ANGLES['engine_speed']
PHASE_NUMBERS = {phase: float(number) for number, phase in enumerate(PHASES)}
"""Index in PHASES by phase, as signals have it."""


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
        self, parameters: DrivelineParameters, vehicle: VehicleParameters, initial: InitialState
    ) -> None:
        """Start in the given state, whose load torque is that of air and slope only."""
        self._parameters = parameters
        self._wheel_radius = vehicle.wheel_radius_m
        self._integrator = friction_integrator(parameters)
        state = [*initial.states, *[0.0] * len(ANGLES)]
        friction = [initial.clutch_torque, initial.wheel_torque]
        signs = self._integrator.mode_of(state)
        self.now = Interval(state, signs, [], [0.0, 0.0], friction)
        """Result of the last period: state, mode, events and friction work of both elements."""
        self._clutch_phase = (
            OPEN if initial.clutch_open else phase_of(signs[CLUTCH], initial.clutch_torque)
        )
        self._torques = (initial.engine_torque, initial.load_torque, initial.wheel_torque)
        self._steps = 0

    @property
    def engine_speed(self) -> float:
        """Engine speed w_m in rad/s at the present step."""
        return self.now.state[_ENGINE_SPEED]

    def outputs(self) -> DrivelineOutputs:
        """Return the outputs at the present step; the wheel's effort includes its friction."""
        now = self.now
        engine_torque, load_torque, _ = self._torques
        clutch_torque, wheel_torque = now.friction
        return driveline_outputs(
            self._parameters,
            self._wheel_radius,
            now.state,
            (engine_torque, clutch_torque, load_torque + wheel_torque),
            clutch_sticks=now.signs[CLUTCH] == 0,
            wheels_stick=now.signs[WHEEL] == 0,
            clutch_phase=PHASE_NUMBERS[self._clutch_phase],
            friction_work=now.work[CLUTCH],
            phase_events=phase_events(now.events, CLUTCH, self._steps - 1) if now.events else (),
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

        All torques are in N m. `load_torque` is that of air and slope; `holding_torque`, the
        capacity of rolling resistance and brake at the wheel, is held too. Raise ParameterError
        for a negative capacity, or a static one below the kinetic one.
        """
        kinetic = static = [*kinetic_torque, holding_torque]
        if static_torque is not kinetic_torque:
            static = [*static_torque, holding_torque]
        now = self.now = self._integrator.advance(
            self.now.state, self.now.signs, (engine_torque, load_torque), kinetic, static
        )
        self._clutch_phase = phase_of(now.signs[CLUTCH], kinetic_torque[-1])
        self._torques = (engine_torque, load_torque, holding_torque)
        self._steps += 1


def phase_of(sign: int, capacity: float) -> str:
    """Return the phase of a clutch with the sign of its slip and its capacity in N m."""
    if sign == 0:
        return LOCKED
    return SLIPPING if capacity else OPEN


def phase_events(events: Sequence[Event], element: int, step: int) -> tuple[PhaseEvent, ...]:
    """Return the events of one element in the period of a step, in the order of time."""
    start_s = time_of_step(step)
    return tuple(
        PhaseEvent(start_s + event.time_s, event.kind, event.slip_acceleration)
        for event in events
        if event.element == element
    )


def friction_system(parameters: DrivelineParameters) -> FrictionSystem:
    """Return the driveline as a linear system with two friction elements, clutch and wheel."""
    a, b = matrices_with_angles(parameters)
    engine, clutch, load = (b[:, TORQUES.column(name)] for name in TORQUES)
    h = np.zeros((2, len(a)))
    h[CLUTCH, STATES_AND_ANGLES.places('engine_speed', 'shaft_speed')] = 1.0, -1.0
    h[WHEEL, STATES_AND_ANGLES['wheel_speed']] = 1.0
    return FrictionSystem(a, np.hstack([engine, load]), np.hstack([clutch, load]), h)


@lru_cache
def friction_integrator(parameters: DrivelineParameters) -> HybridIntegrator:
    """Return the integrator; raise ParameterError where the rates are too fast for 1 ms pieces."""
    return HybridIntegrator(friction_system(parameters), SUBSTEP_S, SUBSTEPS, _HELD)
