# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Handovers of many shifts at once, the counterparts of `ddct_controllers.handover`."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.open_loops import static_torques
from ddct_bringup.batch.stacks import stacked
from ddct_controllers.handover.interface import (
    CUT_FADE_RAD_S,
    CUT_RISE_LAGS,
    CUT_RISE_S,
    MARGIN,
    HandoverCommand,
    HandoverMeasurement,
)
from ddct_controllers.handover.laws import (
    FOUND,
    INTEGRAL,
    LEAST_SHARE,
    PROPORTIONAL,
    SEARCH_FALL,
    SEARCH_FROM,
)
from ddct_plant.base.timebase import PERIOD_S, steps_in
from ddct_plant.scenario.control import ClosingParameters
from ddct_plant.scenario.rules.shift import gears_of, shift_of
from ddct_plant.scenario.settings import KnownSettings
from ddct_plant.shift.balance import OffGoingBalance


class HandoverModels:
    """
    The rigid cars of R shifts, the counterpart of `HandoverModel`; every value is (R,).

    All shifts start at one step. C_load of everything that resists is given with each measurement,
    since the architecture has the same.
    """

    def __init__(self, runs: Sequence[KnownSettings]) -> None:
        """Use the gears and the cars of the settings."""
        scenarios = [run.scenario for run in runs]
        shifts = [shift_of(scenario) for scenario in scenarios]
        closing = [each.closing or ClosingParameters() for each in scenarios]
        self._balance = stacked([OffGoingBalance.of(gears_of(each)) for each in scenarios])
        drivelines = [each.controlled_driveline for each in scenarios]
        self._static = static_torques(drivelines, [each.equilibrium for each in scenarios])
        self._cut = np.array([shift.torque_cut_n_m for shift in shifts])
        lags_s = np.array([each.actuator.lag_s for each in scenarios])
        self._cut_rise_s = np.maximum(CUT_RISE_S, CUT_RISE_LAGS * lags_s)
        self._rise = np.zeros(len(runs))
        self._margin = np.array([each.margin for each in closing])
        self._reserve = np.array([each.reserve_n_m for each in closing])
        most = zip(closing, scenarios, strict=True)
        self._most = np.array([each.most_request(scenario.friction) for each, scenario in most])
        self.start_step = scenarios[0].control_start_step
        """Step at which the shifts start."""
        self.steps = np.array([steps_in('shift.handover_s', each.handover_s) for each in shifts])
        """Number of periods of each handover."""

    def on_coming(self, now: HandoverMeasurement, load_torque: Any) -> Any:
        """Return C_fOL in N m, which the on-coming clutches carry at the share 1."""
        shaft_speed = now.engine_speed - now.on_coming_slip
        return self._static.torque(now.demand, load_torque, now.engine_speed, shaft_speed)

    def off_going(
        self, now: HandoverMeasurement, load_torque: Any, on_coming_torque: Any = 0.0
    ) -> Any:
        """Return the torques in N m that the off-going clutches carry while they are locked."""
        return self._balance.torque(now.demand, load_torque, now.engine_speed, on_coming_torque)

    def off_going_request(
        self, now: HandoverMeasurement, load_torque: Any, on_coming_torque: Any
    ) -> Any:
        """Return the requests in N m with which the off-going clutches stick, with `MARGIN`."""
        return MARGIN * np.maximum(self.off_going(now, load_torque, on_coming_torque), 0.0)

    def locked_request(self, now: HandoverMeasurement, load_torque: Any) -> Any:
        """Return the requests in N m of the off-going clutches before the shift."""
        carried = np.abs(self.off_going(now, load_torque))
        reserved = np.minimum(self._margin * carried + self._reserve, self._most)
        return np.maximum(reserved, carried)

    def locked(self, now: HandoverMeasurement, load_torque: Any) -> HandoverCommand:
        """Return the commands before the shift."""
        none: Any = np.zeros(len(self.steps))
        return HandoverCommand(none, self.locked_request(now, load_torque), none, none, none)

    def during_and_after(
        self, now: HandoverMeasurement, share: Any, off_going_request: Any
    ) -> HandoverCommand:
        """
        Return the commands from the start on, with these shares and off-going requests in N m.

        A share of 1 is the inertia phase: the off-going clutch is open, and a torque cut rises,
        and fades to the lock.
        """
        whole = share == 1.0
        risen = np.minimum(self._rise + PERIOD_S / self._cut_rise_s, 1.0)
        self._rise = np.where(whole, risen, self._rise)
        fade = np.minimum(np.maximum(now.on_coming_slip, 0.0) / CUT_FADE_RAD_S, self._rise)
        none: Any = np.zeros(len(self.steps))
        cut: Any = np.where(whole, fade * self._cut, 0.0)
        request: Any = np.where(whole, 0.0, off_going_request)
        return HandoverCommand(share, request, cut, none, none)


class StackedHandover(ABC):
    """A law of R handovers, called once per period, in order; each value of a command is (R,)."""

    def __init__(self, runs: Sequence[KnownSettings]) -> None:
        """Start before the shift."""
        self.model = HandoverModels(runs)
        """The rigid cars."""

    def update(self, now: HandoverMeasurement, load_torque: np.ndarray) -> HandoverCommand:
        """
        Return the commands for the period of t_k, and do not look at other runs.

        The values of `now` are (R,), but for its step. `load_torque` is C_load in N m, (R,), of
        everything that resists, as controllers know it at the measured speeds.
        """
        elapsed = now.step - self.model.start_step
        if elapsed <= 0:
            return self.locked(now, load_torque)
        return self.since_start(now, load_torque, elapsed)

    def locked(self, now: HandoverMeasurement, load_torque: np.ndarray) -> HandoverCommand:
        """Return the commands before the shift."""
        return self.model.locked(now, load_torque)

    @abstractmethod
    def since_start(
        self, now: HandoverMeasurement, load_torque: np.ndarray, elapsed: int
    ) -> HandoverCommand:
        """Return the commands `elapsed` periods after the start of the shift, from 1 on."""

    def share(self, elapsed: int) -> Any:
        """Return the shares that rise over `shift.handover_s`."""
        return np.minimum(elapsed / self.model.steps, 1.0)


class TimedHandovers(StackedHandover):
    """The counterpart of `TimedHandover`."""

    def locked(self, now: HandoverMeasurement, load_torque: np.ndarray) -> HandoverCommand:
        """Return the commands before the shift."""
        command = super().locked(now, load_torque)
        self._first_request = command.off_going_request
        return command

    def since_start(
        self, now: HandoverMeasurement, load_torque: np.ndarray, elapsed: int
    ) -> HandoverCommand:
        """Return the commands `elapsed` periods after the start of the shift."""
        share = self.share(elapsed)
        return self.model.during_and_after(now, share, (1.0 - share) * self._first_request)


class ModelHandovers(StackedHandover):
    """The counterpart of `ModelHandover`."""

    def since_start(
        self, now: HandoverMeasurement, load_torque: np.ndarray, elapsed: int
    ) -> HandoverCommand:
        """Return the commands `elapsed` periods after the start of the shift."""
        share = self.share(elapsed)
        on_coming = share * self.model.on_coming(now, load_torque)
        request = self.model.off_going_request(now, load_torque, on_coming)
        return self.model.during_and_after(now, share, request)


class SlipHandovers(StackedHandover):
    """The counterpart of `SlipHandover`."""

    def __init__(self, runs: Sequence[KnownSettings]) -> None:
        """Start locked."""
        super().__init__(runs)
        scenarios = [run.scenario for run in runs]
        inertia = np.array([each.driveline.engine_inertia for each in scenarios])
        lag_ms = np.array([round(1e3 * each.actuator.lag_s) for each in scenarios])
        self._target = np.array([shift_of(each).handover_slip_rad_s for each in scenarios])
        self._proportional = 1e3 * PROPORTIONAL / lag_ms * inertia
        self._integral_per_step = 1e6 * INTEGRAL / lag_ms**2 * inertia * PERIOD_S
        self._search_rate = 1e3 * SEARCH_FALL / lag_ms
        self._difference = np.zeros(len(runs))
        """Request less the balance in N m that the slip needs, once the clutch slips."""
        self._slips = np.zeros(len(runs), dtype=bool)
        self._open = np.zeros(len(runs), dtype=bool)
        self._rise_steps = np.zeros(len(runs), dtype=int)

    def since_start(
        self, now: HandoverMeasurement, load_torque: np.ndarray, elapsed: int
    ) -> HandoverCommand:
        """Return the commands `elapsed` periods after the start of the shift."""
        searched: Any = 0.0
        carried: Any = 0.0
        if not self._slips.all():
            carried = self.model.off_going(now, load_torque)
            searched = SEARCH_FROM - self._search_rate * PERIOD_S * elapsed
            found = (now.off_going_slip >= FOUND * self._target) | (searched < LEAST_SHARE)
            # It slips by the torque of what was requested a lag before.
            difference = (searched + SEARCH_FALL) * carried
            self._difference = np.where(found & ~self._slips, difference, self._difference)
            self._slips |= found
        self._rise_steps += self._slips
        share = np.minimum(self._rise_steps / self.model.steps, 1.0)
        request = self._request(now, load_torque, share)
        self._open |= self._slips & (request <= 0.0)
        searching = np.maximum((1.0 + searched) * carried, 0.0)
        given = np.where(self._open, 0.0, np.maximum(request, 0.0))
        return self.model.during_and_after(now, share, np.where(self._slips, given, searching))

    def _request(self, now: HandoverMeasurement, load_torque: np.ndarray, share: Any) -> Any:
        """Return the off-going requests in N m before they are cut off below zero."""
        on_coming = share * self.model.on_coming(now, load_torque)
        carried = self.model.off_going(now, load_torque, on_coming)
        error: Any = now.off_going_slip - self._target
        integrated = self._difference + self._integral_per_step * error
        self._difference = np.where(self._slips & ~self._open, integrated, self._difference)
        return carried + self._difference + self._proportional * error
