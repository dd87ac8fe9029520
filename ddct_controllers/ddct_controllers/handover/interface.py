# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Interface of handovers: measurement and command of a period, and the model that all share."""

from abc import ABC, abstractmethod
from typing import NamedTuple, Self

from ddct_plant.base.timebase import PERIOD_S, steps_in, time_of_step
from ddct_plant.models.load import RoadLoad
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.plant import Tick
from ddct_plant.scenario.initial_state import locked_request
from ddct_plant.scenario.rules.shift import gears_of, shift_of
from ddct_plant.scenario.settings import KnownSettings
from ddct_plant.shift.balance import OffGoingBalance, OnComingShare

MARGIN = 1.7
"""
Request of the off-going clutch over the torque that it carries, in `model` and `adaptive`.

The driveshaft unwinds as the wheel torque falls, and its oscillation needs more of the clutch than
the rigid driveline; a worn clutch carries less than requested. Both matter most near the end,
where the balance is small: with this margin the engine of a packaged shift runs ahead by less than
5 rad/s. Tie-up hardly grows with it, since it vanishes with the balance.
"""
CUT_RISE_S, CUT_RISE_LAGS = 0.1, 2.0
"""
Least time in s in which a torque cut rises to its value, and the least in lags of the actuator.

An engine that gives up its torque at once is ahead of the clutch, whose torque follows C_fOL with
a lag: the wheels jerk, and feedback opens the clutch.
"""
CUT_FADE_RAD_S = 30.0
"""Slip speed of the on-coming clutch in rad/s below which a torque cut fades."""


class HandoverMeasurement(NamedTuple):
    """Signals that a handover receives at step k."""

    step: int
    """Step k."""
    demand: float
    """Driver's demand of C_m in N m."""
    engine_speed: float
    """Engine speed w_m in rad/s."""
    on_coming_slip: float
    """Slip speed of the on-coming clutch in rad/s."""
    off_going_slip: float
    """Slip speed of the off-going clutch in rad/s."""
    vehicle_speed: float
    """Vehicle speed V_x in m/s."""

    @classmethod
    def of_tick(cls, tick: Tick) -> Self:
        """Return the signals of a tick of a shift."""
        speeds = tick.measured
        assert tick.off_going_slip is not None
        return cls(
            tick.step,
            tick.demand,
            speeds.engine_speed,
            speeds.slip_speed,
            tick.off_going_slip,
            speeds.vehicle_speed,
        )


class HandoverCommand(NamedTuple):
    """Command of a handover for the coming period."""

    share: float
    """Share of C_fOL that the on-coming clutch carries, 0 to 1; feedback starts with 1."""
    off_going_request: float
    """Torque request of the off-going clutch in N m."""
    torque_cut: float
    """Torque in N m that is taken off the driver's demand."""
    wear_deviation: float = 0.0
    """Estimate of the wear gain of the on-coming clutch less 1, which divides its requests."""
    torque_offset: float = 0.0
    """Estimate in N m of what it carries beyond that, which is taken off them before."""

    @property
    def on_coming(self) -> OnComingShare:
        """What the on-coming clutch takes over."""
        return OnComingShare(self.share, self.wear_deviation, self.torque_offset)

    @property
    def signals(self) -> dict[str, float]:
        """Values by the names of the run's signals, but for the off-going request."""
        return {
            'handover_share': self.share,
            'on_coming_wear_deviation': self.wear_deviation,
            'on_coming_torque_offset': self.torque_offset,
            'torque_cut': self.torque_cut,
        }


class Handover(ABC):
    """A law of the handover, made for a run, called once per period, in order."""

    def __init__(self, settings: KnownSettings) -> None:
        """Start before the shift; a law with parameters or state overrides this."""
        super().__init__()

    @abstractmethod
    def update(self, measurement: HandoverMeasurement) -> HandoverCommand:
        """Return the command for the period of t_k."""


class HandoverModel:
    """Torques of the rigid car that handovers expect, and the parts of a command they share."""

    def __init__(self, settings: KnownSettings) -> None:
        """Use the gears and the car of the settings."""
        self._scenario = scenario = settings.scenario
        shift, self._balance = shift_of(scenario), OffGoingBalance.of(gears_of(scenario))
        self._static = StaticTorque(scenario.controlled_driveline, scenario.equilibrium)
        self._road = RoadLoad(scenario.load, scenario.vehicle, scenario.slope)
        self._cut, self._rise = shift.torque_cut_n_m, 0.0
        self._cut_rise_s = max(CUT_RISE_S, CUT_RISE_LAGS * scenario.actuator.lag_s)
        self.start_step = scenario.control_start_step
        """Step at which the shift starts."""
        self.steps = steps_in('shift.handover_s', shift.handover_s)
        """Number of periods of the handover."""

    def load(self, now: HandoverMeasurement) -> float:
        """Return C_load in N m of everything that resists."""
        return self._road.torque(now.vehicle_speed, time_of_step(now.step))

    def on_coming(self, now: HandoverMeasurement) -> float:
        """Return C_fOL in N m, which the on-coming clutch carries at the share 1."""
        load = self.load(now)
        shaft_speed = now.engine_speed - now.on_coming_slip
        return self._static.torque(now.demand, load, now.engine_speed, shaft_speed)

    def off_going(self, now: HandoverMeasurement, on_coming_torque: float = 0.0) -> float:
        """Return the torque in N m that the off-going clutch carries while it is locked."""
        load = self.load(now)
        return self._balance.torque(now.demand, load, now.engine_speed, on_coming_torque)

    def off_going_request(self, now: HandoverMeasurement, on_coming_torque: float) -> float:
        """Return the request in N m with which the off-going clutch sticks, with `MARGIN`."""
        return MARGIN * max(self.off_going(now, on_coming_torque), 0.0)

    def locked(self, now: HandoverMeasurement) -> HandoverCommand:
        """Return the command before the shift: the off-going clutch is locked with a margin."""
        return HandoverCommand(0.0, locked_request(self._scenario, self.off_going(now)), 0.0)

    def inertia_phase(self, now: HandoverMeasurement) -> HandoverCommand:
        """Return the command after the handover; a torque cut rises, and fades to the lock."""
        self._rise = min(self._rise + PERIOD_S / self._cut_rise_s, 1.0)
        fade = min(max(now.on_coming_slip, 0.0) / CUT_FADE_RAD_S, self._rise)
        return HandoverCommand(1.0, 0.0, fade * self._cut)
