# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The drive of a log: torques, road and initial speeds, from its first complete row on."""

import dataclasses
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ddct_bringup.bag.measured_keys import MeasuredKeys
from ddct_bringup.identification.from_log.base_car import drag_of
from ddct_bringup.identification.from_log.problem import used
from ddct_bringup.identification.from_log.response import residuals_of
from ddct_bringup.identification.from_log.result import SIGMAS_95, LogFit
from ddct_bringup.identification.from_log.stretches import LOAD, OUTPUTS, Stretch
from ddct_bringup.logs.log import MeasuredLog
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_S, time_of_step
from ddct_plant.models.load import BrakeProfile, SlopeProfile
from ddct_plant.models.parameters import DrivelineShafts
from ddct_plant.scenario.content import scenario_content
from ddct_plant.scenario.csv_profiles import MOST_ROWS
from ddct_plant.scenario.initial_speeds import InitialSection
from ddct_plant.scenario.nouns.keys import DRIVE, by_noun
from ddct_plant.scenario.nouns.part import DESCRIPTION
from ddct_plant.scenario.scenario import Scenario

STEEPEST_RAD = 0.6
"""Largest slope angle in rad of a drive."""
SHAFTS = tuple(field.name for field in dataclasses.fields(DrivelineShafts))
"""Parameters that depend neither on the gear nor on the vehicle."""
_PIECES = 10
"""Number of instants of a period over which a torque is averaged."""


@dataclass(frozen=True)
class LogDrive:
    """What a log shows of car and drive, from its first complete row on."""

    base: Scenario
    """Car and drive that the fit started from, with the wheel radius of the log."""
    fit: LogFit
    log: MeasuredLog
    run: Mapping[str, Any]
    """Keys of `run` of a column map, which may have control start and score window."""
    stretches: Sequence[Stretch]

    @property
    def description(self) -> str:
        """Where car and drive are from."""
        return (
            f'from {self.log.path.name} (SHA-256 {self.log.digest}...), from '
            f'{self.start_s:.6g} s on: fitted {", ".join(self.fit.std)}'
        )

    @property
    def start_s(self) -> float:
        """First time in s with all signals."""
        return float(self.stretches[0].time_s[0])

    @property
    def steps(self) -> int:
        """Number of whole periods of the log."""
        span = self.stretches[-1].time_s[-1] - self.start_s
        return int(math.floor(span / PERIOD_S + 1e-6))

    @property
    def moved(self) -> Scenario:
        """Base with the driveline of the fit: its gear, and the mass J_v / r_w^2."""
        driveline, vehicle = self.fit.parameters, self.base.vehicle
        gearbox, gear = self.base.gearbox.with_measured(driveline.gear)
        mass = driveline.vehicle_inertia / vehicle.wheel_radius_m**2
        shafts = {name: getattr(driveline, name) for name in SHAFTS}
        return dataclasses.replace(
            self.base,
            vehicle=dataclasses.replace(vehicle, mass_kg=mass),
            given_driveline=dataclasses.replace(self.base.given_driveline, **shafts),
            gearbox=gearbox,
            gear=gear,
            shift=None,
            given_initial=InitialSection(),
        )

    def content(self) -> dict[str, Any]:
        """Return the content of the drive, but for its profiles."""
        duration, moved = time_of_step(self.steps), self.moved
        start, window = self._times(duration)
        load = moved.load
        if self.fit.load_torque is not None:
            slope = self._slopes(np.array([self.fit.load_torque]))[0]
            load = dataclasses.replace(load, slope_rad=float(slope))
        elif LOAD in self.log.signals:
            load = dataclasses.replace(load, slope_rad=0.0)
        driven = dataclasses.replace(
            moved,
            duration_s=duration,
            control_start_s=start,
            score_window_s=window,
            given_initial=self._initial(),
            load=load,
            slope=SlopeProfile(),
            brake=BrakeProfile(),
        )
        content = by_noun(scenario_content(driven))[DRIVE]
        return {DESCRIPTION: self.description, **{k: v for k, v in content.items() if _has(v)}}

    def tables(self) -> dict[str, list[tuple[float, float]]]:
        """
        Return the rows of time in s and value of each profile, the means over whole periods.

        A plant holds its inputs over a period, so the mean has the same effect on the car.
        """
        periods = np.arange(0, self.steps, self._every)
        times = [time_of_step(int(each)) for each in periods]
        found = {'engine': np.maximum(self._means('engine_torque', periods), 0.0)}
        if self.fit.load_torque is None:
            wheels = self._means('wheel_speed', periods)
            road = self._means(LOAD, periods) - drag_of(self.base)(wheels)
            found['slope'] = self._slopes(road)
        return {
            section: list(zip(times, values.tolist(), strict=True))
            for section, values in found.items()
        }

    @property
    def notes(self) -> list[str]:
        """What car and drive do not have of the log, as sentences."""
        found = [*self._lost_gears()]
        least = float(self._means('engine_torque', np.arange(self.steps)).min())
        if least < 0.0:
            found.append(
                f'the engine torque of the drive is 0 where the log has less, down to {least:.4g} '
                'N m: a demand has no engine braking'
            )
        if self._every > 1:
            found.append(
                f'the profiles of the drive have a point every {self._every * PERIOD_S:g} s: they '
                f'have at most {MOST_ROWS} points'
            )
        return found

    def _lost_gears(self) -> Iterator[str]:
        """Yield a note where the ratio of the log is that of no gear of the base."""
        gearbox, gear = self.base.gearbox, self.fit.parameters.gear
        if self.moved.gearbox.gears < gearbox.gears:
            number = gearbox.nearest(gear)
            nearest = gearbox.gear(number)
            radius = self.base.vehicle.wheel_radius_m * nearest.shaft_ratio(gear)
            yield (
                f'the total ratio of {gear} is that of no gear (gear {number} has '
                f'{nearest}), so the new car has this gear alone and cannot '
                'shift: give a car with its gears by --car, or, if the wheel speed is in km/h and '
                f'this is gear {number}, radius_m: {radius:.4g} in the column map'
            )

    @property
    def _every(self) -> int:
        """Number of periods from one point of a profile to the next."""
        return -(-self.steps // MOST_ROWS)

    def _means(self, name: str, periods: np.ndarray) -> np.ndarray:
        """Return the means of a quantity over periods, at the times of the car."""
        pieces = (np.arange(_PIECES) + 0.5) / _PIECES
        late = self.fit.delays.get(name, 0.0)
        times = (periods[:, None] + pieces) * PERIOD_S + self.start_s + late
        return np.asarray(self.log.at(name, times).mean(axis=1))

    def _slopes(self, load_torque: np.ndarray) -> np.ndarray:
        """Return the slopes a in rad with m g (mu cos a + sin a) r_w = `load_torque`, (n,)."""
        vehicle, rolling = self.moved.vehicle, self.base.load.rolling_coefficient
        weight_torque = vehicle.mass_kg * vehicle.gravity_m_s2 * vehicle.wheel_radius_m
        shares = load_torque / weight_torque / math.hypot(1.0, rolling)
        slopes = np.arcsin(np.clip(shares, -1.0, 1.0)) - math.atan(rolling)
        worst = int(np.argmax(np.abs(slopes)))
        if abs(slopes[worst]) > STEEPEST_RAD:
            raise DdctError(
                f'no road gives a car of {vehicle.mass_kg:.4g} kg a C_load of '
                f'{load_torque[worst]:.4g} N m at the wheels: check units and signs of '
                'the torques',
                place=self.log.path,
            )
        return np.asarray(slopes)

    def _initial(self) -> InitialSection:
        """Return the fitted speeds of both plates, equal if noise and delays explain the slip."""
        (first, *_) = used(self.stretches, self.fit.all_values)
        left = residuals_of(self.fit.all_values, first)[0]
        names = ('engine_speed', 'shaft_speed')
        speeds, times = (first.speeds - left)[:, OUTPUTS.places(*names)], first.time_s
        engine, shaft = (
            float(np.interp(self.start_s + self.fit.delays[name], times, each))
            for name, each in zip(names, speeds.T, strict=True)
        )
        rates = np.diff(speeds[:2], axis=0)[0] / (times[1] - times[0])
        late = rates * [self.fit.delay_std.get(name, 0.0) for name in names]
        noise = np.std(left[:, 0] - left[:, 1])
        if abs(engine - shaft) <= SIGMAS_95 * math.hypot(noise, *late.tolist()):
            shaft = engine
        return InitialSection(
            engine_speed_rad_s=max(engine, 0.0), shaft_speed_rad_s=max(shaft, 0.0)
        )

    def _times(self, duration_s: float) -> tuple[float, tuple[float, float]]:
        """
        Return control start and score window in s of the drive.

        `run` may give them. Else control starts where the slip is largest in the first
        half of the log, and the window is the rest of the log.
        """
        keys = MeasuredKeys(**self.run)
        moved = 0.0 if keys.start_s is None else self.start_s - keys.start_s
        start = _whole(keys.control_start_s - moved)
        if 'control_start_s' not in self.run:
            periods = np.arange(max(self.steps // 2, 1))
            slip = self._means('engine_speed', periods) - self._means('shaft_speed', periods)
            start = time_of_step(int(np.argmax(np.abs(slip))))
        first, last = start, duration_s
        if keys.score_window_s:
            first, last = (_whole(each - moved) for each in keys.score_window_s)
        if not (0.0 <= start < last <= duration_s and 0.0 <= first < last):
            raise DdctError(
                f'the drive has {duration_s:g} s, and a control start at {start:g} s with a score '
                f'window from {first:g} to {last:g} s: mend run.start_s, run.control_start_s and '
                'run.score_window_s in the column map, or --set both',
                key='run.control_start_s',
            )
        return start, (first, last)


def _whole(time_s: float) -> float:
    """Return a time in s as a whole number of periods."""
    return time_of_step(round(time_s / PERIOD_S))


def _has(section: Any) -> bool:
    """Return whether a value or section is more than a profile without points."""
    return not isinstance(section, dict) or any(value != [] for value in section.values())
