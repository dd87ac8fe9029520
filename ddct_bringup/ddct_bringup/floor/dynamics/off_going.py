# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Torque of the off-going clutch of a shift in the inertia phase, until that clutch is open."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.dynamics import propagators
from ddct_bringup.floor.dynamics.capacity import COOLER_K, WARMER_K
from ddct_bringup.floor.dynamics.shapes import most_shapes
from ddct_bringup.metrics.signals.integrals import integral
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S, SUBSTEP_S
from ddct_plant.models.clutch import FrictionClutch
from ddct_plant.scenario.plant import OPEN_BELOW
from ddct_plant.scenario.rules.shift import gears_of, shift_of
from ddct_plant.scenario.settings import RunSettings


@dataclass(frozen=True, eq=False)
class OffGoing:
    """
    What is known of the off-going clutch from the start of the inertia phase on.

    Its request is zero there, so its actuator's torque decays as in every other run. Until a
    request of the controller acts, so does C_1. Afterwards the clutch may stick or slip either
    way: its torque is then a variable within its capacity, and zero once it is open.
    """

    requests: np.ndarray
    """Requests up to the start of the inertia phase in N m, (step + 1,)."""
    temperature_c: float
    """Temperature of its facing there in degrees Celsius."""
    effects: np.ndarray
    """What C_1 adds to the states over the first periods, in which no request acts yet, (m, 4)."""
    most: np.ndarray
    """Largest size of the coefficients of C_1 in N m in the periods after these, (n, 4)."""
    impulse: float
    """Integral of its largest capacity over time in N m s."""

    @property
    def known(self) -> int:
        """Number of periods in which C_1 is the same in all runs."""
        return len(self.effects)

    @property
    def periods(self) -> int:
        """Number of periods until the clutch is open."""
        return len(self.effects) + len(self.most)

    @property
    def open_s(self) -> float:
        """Time in s from the start of the inertia phase from which on the clutch is open."""
        return self.periods * PERIOD_S

    def require_open(self, lock_time_s: float) -> None:
        """Raise ParameterError where the clutch is not open at a lock time in s."""
        if lock_time_s <= self.open_s:
            raise ParameterError(
                f'lock time {lock_time_s:g} s: the off-going clutch may carry torque up to '
                f'{self.open_s:g} s after the start of the inertia phase: there is no floor'
            )

    def agrees(self, run: Trajectory) -> bool:
        """Return whether a run has these requests, none afterwards, and a facing as warm."""
        step = len(self.requests) - 1
        requests = np.maximum(run.off_going_torque_request, 0.0)
        warmed = run.off_going_clutch_temperature[step : step + self.periods] - self.temperature_c
        return bool(
            np.array_equal(requests[: step + 1], self.requests)
            and not requests[step:].any()
            and np.all((warmed >= -COOLER_K) & (warmed <= WARMER_K))
        )


def off_going_of(settings: RunSettings, run: Trajectory, step: int, unforced: int) -> OffGoing:
    """
    Return the off-going clutch of a recorded run from the step of the inertia phase on.

    No request acts in the first `unforced` periods. Raise ParameterError where the handover does
    not open the clutch at once and for good, or the gear is disengaged.
    """
    requests = np.maximum(run.off_going_torque_request, 0.0)
    if requests[step:].any():
        raise ParameterError(
            f'handover {settings.known.handover_name}: it requests torque of the off-going clutch '
            'after its share of C_fOL is 1: there is no floor',
            key='handover',
        )
    if shift_of(settings.scenario).disengagement_s is not None:
        raise ParameterError(
            'shift.disengagement_s: from then on the off-going shaft does not turn with the car: '
            'leave it out, there is no floor of a shift whose off-going gear is disengaged',
            key='shift.disengagement_s',
        )
    temperature = float(run.off_going_clutch_temperature[step])
    capacity = _most_capacity(settings, run.off_going_actuator_torque[step:], temperature)
    carrying = np.flatnonzero(capacity.any(axis=1))
    periods = int(carrying[-1]) + 1 if carrying.size else 0
    if periods >= len(capacity):
        raise ParameterError(
            'the off-going clutch is not open before the end of the run: there is no floor'
        )
    known = min(unforced, periods)
    return OffGoing(
        requests[: step + 1],
        temperature,
        effects_of_run(settings, run, range(step, step + known)),
        most_shapes(gears_of(settings.scenario), capacity[known:periods]),
        float(integral(capacity, dx=SUBSTEP_S).sum()),
    )


def effects_of_run(settings: RunSettings, run: Trajectory, periods: range) -> np.ndarray:
    """
    Return what C_1 of a run added to w_m, w_p, w_r and theta_sr in each of the periods, (n, 4).

    It is the difference of the states from those that the other torques lead to. The on-coming
    clutch slips one way in these periods.
    """
    matrix = propagators.slipping(settings.scenario.controlled_driveline)
    states = np.column_stack(
        [run.engine_speed, run.primary_shaft_speed, run.wheel_speed, run.driveshaft_position]
    )
    torques = np.column_stack(
        [
            run.engine_torque,
            run.load_torque + run.holding_torque,
            np.sign(run.slip_speed)[:, np.newaxis] * run.clutch_torque,
        ]
    )
    first, last = periods.start, periods.stop
    without = np.hstack([states[first:last], torques[first:last]]) @ matrix.T
    return np.asarray(states[first + 1 : last + 1] - without)


def _most_capacity(
    settings: RunSettings, actuator: np.ndarray, temperature_c: float
) -> np.ndarray:
    """Return the largest static capacity in N m for the actuator's torque, both (n, 11)."""
    scenario = settings.scenario
    clutch = FrictionClutch(
        scenario.friction, settings.case.off_going_wear_gain, scenario.heat, OPEN_BELOW
    )
    coolest, hottest = temperature_c - COOLER_K, temperature_c + WARMER_K
    inner = [each for each in scenario.friction.temperature_c if coolest < each < hottest]
    temperatures = (coolest, hottest, *inner) if scenario.friction.temperature_c else (coolest,)
    if scenario.friction.kiss_drift_n_m_k:
        temperatures = tuple(dict.fromkeys((*temperatures, coolest, hottest)))
    return np.array(
        [
            np.max([clutch.capacity(nodes, each).static for each in temperatures], axis=0)
            for nodes in actuator.tolist()
        ]
    )
